# Writes OUTPUT, a C++ source that holds the text of SCRIPT and STYLE.
function(quoted_text file result)
  file(READ ${file} text)
  if(text MATCHES "[)]viewer\"")
    message(FATAL_ERROR "${file} holds the mark that ends its quotation.")
  endif()
  set(${result} "R\"viewer(${text})viewer\"" PARENT_SCOPE)
endfunction()

quoted_text(${STYLE} style)
quoted_text(${SCRIPT} script)
file(WRITE ${OUTPUT} "#include \"report/viewer_assets.h\"

namespace hydrodip {

std::string page_style() { return ${style}; }

std::string viewer_script() { return ${script}; }

}  // namespace hydrodip
")
