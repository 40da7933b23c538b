# Run by CPack when the packages are made: CMake 3.25 calls ldconfig from scripts of its own, which
# Debian leaves to a trigger of dpkg's.
foreach(deb IN LISTS CPACK_PACKAGE_FILES)
  set(work ${CPACK_TOPLEVEL_DIRECTORY}/finish)
  file(REMOVE_RECURSE ${work})
  execute_process(COMMAND dpkg-deb -R ${deb} ${work} COMMAND_ERROR_IS_FATAL ANY)
  if(EXISTS ${work}/DEBIAN/shlibs AND NOT EXISTS ${work}/DEBIAN/triggers)
    file(WRITE ${work}/DEBIAN/triggers "activate-noawait ldconfig\n")
  endif()
  if(EXISTS ${work}/DEBIAN/postinst)
    file(READ ${work}/DEBIAN/postinst script)
    if(script MATCHES "ldconfig")
      file(REMOVE ${work}/DEBIAN/postinst ${work}/DEBIAN/postrm)
      execute_process(COMMAND dpkg-deb --root-owner-group -b ${work} ${deb} OUTPUT_QUIET
                      COMMAND_ERROR_IS_FATAL ANY)
    elseif(NOT script MATCHES "py3compile") # packaging/deb/python's
      message(FATAL_ERROR "${deb}: a script that is not known here:\n${script}")
    endif()
  endif()
  file(REMOVE_RECURSE ${work})
endforeach()
