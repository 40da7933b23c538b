# The report page's 3D view: src/report/viewer/ and three.js (fetched once from the npm registry),
# bundled by esbuild and put into the program together with the page's style.
option(HYDRODIP_VIEWER "3D view in report.html; needs npm, esbuild and once the npm registry" ON)
set(HYDRODIP_NPM_DIR ${CMAKE_BINARY_DIR}/npm CACHE PATH "Where npm packages are kept")

set(viewer_dir ${CMAKE_SOURCE_DIR}/src/report/viewer)
set(viewer_bundle ${CMAKE_BINARY_DIR}/viewer/bundle.js)
set(viewer_cpp ${CMAKE_BINARY_DIR}/viewer/viewer_assets.cpp)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/viewer)

if(HYDRODIP_VIEWER)
  find_program(NPM npm)
  find_program(ESBUILD esbuild)
  # npm is not needed where the packages are there already, as when cross-compiling.
  if(NOT ESBUILD OR (NOT NPM AND NOT EXISTS ${HYDRODIP_NPM_DIR}/fetched))
    message(FATAL_ERROR "npm and esbuild are needed for the 3D view in reports: install the Debian "
                        "packages npm and esbuild, or configure with -DHYDRODIP_VIEWER=OFF.")
  endif()
  set(npm_stamp ${HYDRODIP_NPM_DIR}/fetched)
  add_custom_command(
    OUTPUT ${npm_stamp}
    COMMAND ${CMAKE_COMMAND} -D NPM=${NPM} -D SOURCE=${viewer_dir} -D FOLDER=${HYDRODIP_NPM_DIR}
            -P ${CMAKE_SOURCE_DIR}/cmake/fetch_npm.cmake
    DEPENDS ${viewer_dir}/package.json ${viewer_dir}/package-lock.json
            ${CMAKE_SOURCE_DIR}/cmake/fetch_npm.cmake
    COMMENT "Fetching three.js from the npm registry"
    VERBATIM)
  file(GLOB viewer_sources CONFIGURE_DEPENDS ${viewer_dir}/*.js)
  add_custom_command(
    OUTPUT ${viewer_bundle}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${HYDRODIP_NPM_DIR}/node_modules ${ESBUILD}
            ${viewer_dir}/main.js --bundle --minify --format=iife --target=es2020 --charset=ascii
            --log-level=warning --outfile=${viewer_bundle}
    DEPENDS ${viewer_sources} ${npm_stamp}
    COMMENT "Bundling the report page's 3D view"
    VERBATIM)
else()
  file(WRITE ${viewer_bundle} "")
endif()

add_custom_command(
  OUTPUT ${viewer_cpp}
  COMMAND ${CMAKE_COMMAND} -D SCRIPT=${viewer_bundle} -D STYLE=${viewer_dir}/page.css
          -D OUTPUT=${viewer_cpp} -P ${CMAKE_SOURCE_DIR}/cmake/embed_viewer.cmake
  DEPENDS ${viewer_bundle} ${viewer_dir}/page.css ${CMAKE_SOURCE_DIR}/cmake/embed_viewer.cmake
          ${CMAKE_SOURCE_DIR}/cmake/quoted_text.cmake
  VERBATIM)
target_sources(hydrodip_report PRIVATE ${viewer_cpp})
