# Writes OUTPUT, a C++ source that holds the text of SCRIPT and STYLE.
include(${CMAKE_CURRENT_LIST_DIR}/quoted_text.cmake)

quoted_text(${STYLE} style)
quoted_text(${SCRIPT} script)
file(WRITE ${OUTPUT} "#include \"report/viewer_assets.h\"

namespace hydrodip {

std::string page_style() { return ${style}; }

std::string viewer_script() { return ${script}; }

}  // namespace hydrodip
")
