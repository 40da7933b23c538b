# Installs the packages of SOURCE/package-lock.json into FOLDER with NPM, unless they are there.
file(SHA256 ${SOURCE}/package-lock.json lock)
if(EXISTS ${FOLDER}/fetched AND EXISTS ${FOLDER}/node_modules)
  file(READ ${FOLDER}/fetched fetched)
endif()
if(NOT "${fetched}" STREQUAL "${lock}")
  file(REMOVE ${FOLDER}/fetched)
  file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${FOLDER})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1
            --fetch-retry-mintimeout=1000
    WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message("${output}")
    message(FATAL_ERROR "three.js could not be fetched from the npm registry (see above): connect to "
                        "the network for this one step, or configure with -DHYDRODIP_VIEWER=OFF.")
  endif()
endif()
file(WRITE ${FOLDER}/fetched ${lock})
