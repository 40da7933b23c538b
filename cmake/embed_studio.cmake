# Writes OUTPUT, a C++ source that holds the text of PAGE, SCRIPT and STYLE.
include(${CMAKE_CURRENT_LIST_DIR}/quoted_text.cmake)

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
