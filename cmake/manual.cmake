# Manual pages, completion, schemas and pages of the site, made from the program's own tables by a
# small program that is built from the same files.
file(GLOB manual_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/manual/*.cpp)
add_executable(hydrodip_manual ${manual_sources})
if(HYDRODIP_UNITY)
  hydrodip_unity(hydrodip_manual ${manual_sources})
endif()
target_compile_options(hydrodip_manual PRIVATE -O1) # runs once, for a moment
target_link_libraries(hydrodip_manual PRIVATE hydrodip_command_line CLI11::CLI11
                                              nlohmann_json::nlohmann_json)

set(HYDRODIP_SHARE ${CMAKE_BINARY_DIR}/share)
file(GLOB schemas CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/docs/schemas/*.json)
file(GLOB package_locks CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/*/*/package-lock.json)
set(compress ${CMAKE_COMMAND} -E true)
if(HYDRODIP_DEB)
  set(compress find ${HYDRODIP_SHARE}/man -type f -exec gzip -9nf {} +)
endif()
add_custom_command(
  OUTPUT ${CMAKE_BINARY_DIR}/share_made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${HYDRODIP_SHARE}
  COMMAND hydrodip_manual ${HYDRODIP_SHARE} "hydrodip ${PROJECT_VERSION}" "${HYDRODIP_DATE}"
  COMMAND ${CMAKE_COMMAND} -E copy ${schemas} ${HYDRODIP_SHARE}/hydrodip/schemas
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${CMAKE_SOURCE_DIR} -D VERSION=${PROJECT_VERSION}
          -D DATE=${HYDRODIP_DATE} -D VIEWER=${HYDRODIP_VIEWER}
          -D OUTPUT=${HYDRODIP_SHARE}/hydrodip/hydrodip.spdx.json
          -P ${CMAKE_SOURCE_DIR}/cmake/spdx.cmake
  COMMAND ${compress}
  COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/share_made
  DEPENDS hydrodip_manual ${schemas} ${CMAKE_SOURCE_DIR}/cmake/spdx.cmake
          ${package_locks}
  COMMENT "Manual pages, completion, schemas"
  VERBATIM)
add_custom_target(hydrodip_share ALL DEPENDS ${CMAKE_BINARY_DIR}/share_made)
configure_file(packaging/hydrodip.desktop desktop/hydrodip.desktop COPYONLY)
configure_file(packaging/hydrodip.metainfo.xml.in
               desktop/hydrodip.metainfo.xml @ONLY)

set(share ${CMAKE_INSTALL_DATADIR})
install(DIRECTORY ${HYDRODIP_SHARE}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${HYDRODIP_SHARE}/bash-completion ${HYDRODIP_SHARE}/hydrodip
        DESTINATION ${share} COMPONENT program)
install(DIRECTORY ${HYDRODIP_SHARE}/zsh/vendor-completions DESTINATION ${share}/zsh COMPONENT program)
install(DIRECTORY ${HYDRODIP_SHARE}/fish/vendor_completions.d DESTINATION ${share}/fish
        COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/desktop/hydrodip.desktop DESTINATION ${share}/applications
        COMPONENT program)
install(FILES packaging/hydrodip.xml DESTINATION ${share}/mime/packages COMPONENT program)
install(FILES packaging/hydrodip.svg
        DESTINATION ${share}/icons/hicolor/scalable/apps COMPONENT program)
install(FILES ${CMAKE_BINARY_DIR}/desktop/hydrodip.metainfo.xml
        DESTINATION ${share}/metainfo COMPONENT program)
