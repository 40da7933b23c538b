# Writes OUTPUT, a C++ source that holds the text of PAGE, SCRIPT and STYLE.
function(quoted_text file result)
  file(READ ${file} text)
  if(text MATCHES "[)]studio\"")
    message(FATAL_ERROR "${file} holds the mark that ends its quotation.")
  endif()
  set(${result} "R\"studio(${text})studio\"" PARENT_SCOPE)
endfunction()

quoted_text(${PAGE} page)
quoted_text(${SCRIPT} script)
quoted_text(${STYLE} style)
file(WRITE ${OUTPUT} "#include \"studio/page_assets.h\"

namespace hydrodip {

std::string studio_page() { return ${page}; }

std::string studio_script() { return ${script}; }

std::string studio_style() { return ${style}; }

}  // namespace hydrodip
")
