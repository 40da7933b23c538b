# The studio's page: src/studio/page/ and what its package-lock.json names (fetched once from the npm
# registry), bundled by esbuild and put into the program.
set(studio_page_dir ${CMAKE_SOURCE_DIR}/src/studio/page)
set(studio_bundle ${CMAKE_BINARY_DIR}/studio/app.js)
set(studio_cpp ${CMAKE_BINARY_DIR}/studio/page_assets.cpp)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/studio)

if(HYDRODIP_VIEWER)
  set(studio_npm_dir ${HYDRODIP_NPM_DIR}/studio)
  set(studio_npm_stamp ${studio_npm_dir}/fetched)
  add_custom_command(
    OUTPUT ${studio_npm_stamp}
    COMMAND ${CMAKE_COMMAND} -D NPM=${NPM} -D SOURCE=${studio_page_dir} -D FOLDER=${studio_npm_dir}
            -P ${CMAKE_SOURCE_DIR}/cmake/fetch_npm.cmake
    DEPENDS ${studio_page_dir}/package.json ${studio_page_dir}/package-lock.json
            ${CMAKE_SOURCE_DIR}/cmake/fetch_npm.cmake ${npm_stamp}
    COMMENT "Fetching what the studio's page needs from the npm registry"
    VERBATIM)
  # Parts of the report's viewer belong to it (viewer_sources, of viewer.cmake).
  file(GLOB_RECURSE studio_page_sources CONFIGURE_DEPENDS ${studio_page_dir}/*.ts ${studio_page_dir}/*.tsx
       ${studio_page_dir}/tsconfig.json)
  add_custom_command(
    OUTPUT ${studio_bundle}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${studio_npm_dir}/node_modules ${ESBUILD}
            ${studio_page_dir}/main.ts --bundle --minify --format=iife --target=es2020
            --charset=ascii --log-level=warning --outfile=${studio_bundle}
    DEPENDS ${studio_page_sources} ${viewer_sources} ${studio_npm_stamp}
    COMMENT "Bundling the studio's page"
    VERBATIM)
else()
  file(WRITE ${studio_bundle} "")
endif()

add_custom_command(
  OUTPUT ${studio_cpp}
  COMMAND ${CMAKE_COMMAND} -D PAGE=${studio_page_dir}/index.html -D SCRIPT=${studio_bundle}
          -D STYLE=${studio_page_dir}/styles.css -D OUTPUT=${studio_cpp}
          -P ${CMAKE_SOURCE_DIR}/cmake/embed_studio.cmake
  DEPENDS ${studio_bundle} ${studio_page_dir}/index.html ${studio_page_dir}/styles.css
          ${CMAKE_SOURCE_DIR}/cmake/embed_studio.cmake ${CMAKE_SOURCE_DIR}/cmake/quoted_text.cmake
  VERBATIM)
target_sources(hydrodip_studio PRIVATE ${studio_cpp})
