# The public library: hydrodip::hydrodip, for find_package(hydrodip) and pkg-config. One shared
# library made of the folders' objects; whoever uses it needs its headers and Eigen, nothing else.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(HYDRODIP_PUBLIC_FOLDER session) # the folder of src/ beyond which the library does not reach
get_property(folders GLOBAL PROPERTY hydrodip_reach_of_${HYDRODIP_PUBLIC_FOLDER})
list(APPEND folders ${HYDRODIP_PUBLIC_FOLDER})
add_library(hydrodip_library SHARED)
add_library(hydrodip::hydrodip ALIAS hydrodip_library)
foreach(folder ${folders})
  target_sources(hydrodip_library PRIVATE $<TARGET_OBJECTS:hydrodip_${folder}>)
endforeach()
# Of what is linked here only Eigen's types are in public headers.
target_link_libraries(hydrodip_library PUBLIC Eigen3::Eigen PRIVATE hydrodip_${HYDRODIP_PUBLIC_FOLDER})
target_compile_features(hydrodip_library PUBLIC cxx_std_20)
set(staged_headers ${CMAKE_BINARY_DIR}/package/include)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/include/*.h ${CMAKE_SOURCE_DIR}/src/*.h)
add_custom_command(
  OUTPUT ${CMAKE_BINARY_DIR}/package/headers_staged
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${CMAKE_SOURCE_DIR} -D OUTPUT=${staged_headers}
          -P ${CMAKE_SOURCE_DIR}/cmake/stage_headers.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/package/headers_staged
  DEPENDS ${headers} ${CMAKE_SOURCE_DIR}/cmake/stage_headers.cmake
  COMMENT "Collecting the package's headers"
  VERBATIM)
add_custom_target(hydrodip_headers ALL DEPENDS ${CMAKE_BINARY_DIR}/package/headers_staged)
add_dependencies(hydrodip_library hydrodip_headers)
target_include_directories(hydrodip_library PUBLIC $<BUILD_INTERFACE:${staged_headers}>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
# Eigen aligns by the instruction set that a file is compiled for; the library is compiled for the
# common one. With -march=native on one side only, both would lay out the same struct differently.
target_compile_definitions(hydrodip_library INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
set(exported ${CMAKE_SOURCE_DIR}/cmake/exported_symbols.map)
target_link_options(hydrodip_library PRIVATE LINKER:--version-script=${exported} LINKER:--no-undefined
                                             LINKER:-Bsymbolic)
set_target_properties(
  hydrodip_library
  PROPERTIES OUTPUT_NAME hydrodip
             EXPORT_NAME hydrodip
             LINKER_LANGUAGE CXX
             LINK_DEPENDS ${exported}
             VERSION ${PROJECT_VERSION}
             # Until 1.0 every minor version may change the interface.
             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

install(TARGETS hydrodip_library EXPORT hydrodipTargets
        LIBRARY COMPONENT library NAMELINK_COMPONENT dev)
install(DIRECTORY ${staged_headers}/ TYPE INCLUDE COMPONENT dev)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hydrodip)
install(EXPORT hydrodipTargets NAMESPACE hydrodip:: DESTINATION ${package_dir} COMPONENT dev)
configure_package_config_file(cmake/hydrodipConfig.cmake.in package/hydrodipConfig.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/hydrodipConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/hydrodipConfig.cmake
              ${CMAKE_BINARY_DIR}/package/hydrodipConfigVersion.cmake DESTINATION ${package_dir}
        COMPONENT dev)
file(RELATIVE_PATH up_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/hydrodip.pc.in package/hydrodip.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/package/hydrodip.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT dev)
