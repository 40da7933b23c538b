# Writes OUTPUT, where the program's version stands, if it differs from what is there: at build
# time, so that a commit costs one link and no configuring.
include(${SOURCE_FOLDER}/cmake/version.cmake)
set(text "#include \"build_version.h\"\n\nconst char* hydrodip::build_version() { return \"${HYDRODIP_VERSION_TEXT}\"; }\n")
set(there "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} there)
endif()
if(NOT text STREQUAL there)
  file(WRITE ${OUTPUT} "${text}")
endif()
