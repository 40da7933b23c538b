# Put into the examples' project by package.configure: headers are most of what compiling them takes,
# and here they are compiled once for all.
function(share_headers)
  get_property(examples DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  list(POP_FRONT examples first)
  target_precompile_headers(${first} PRIVATE <hydrodip/hydrodip.h>)
  foreach(example ${examples})
    target_precompile_headers(${example} REUSE_FROM ${first})
  endforeach()
endfunction()
cmake_language(DEFER CALL share_headers)
