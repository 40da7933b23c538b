# Debian packages by CPack, one for each component; `./dev package` builds, checks and tries them.
# Included after all components are known.
if(NOT HYDRODIP_DEB)
  return()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hydrodip)
set(CPACK_PACKAGE_VENDOR "hydrodip authors")
set(CPACK_PACKAGE_CONTACT "hydrodip authors <maintainers@localhost>")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/debs)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${CPACK_PACKAGE_CONTACT}")
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${HYDRODIP_DEB_ARCHITECTURE})
endif()

# A commit after the last tag sorts after it, and before the next.
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION})
if(NOT HYDRODIP_VERSION_TEXT STREQUAL PROJECT_VERSION)
  string(REGEX MATCH "[0-9a-f]+\\)$" commit ${HYDRODIP_VERSION_TEXT})
  string(REPLACE ")" "" commit "${commit}")
  string(REPLACE "-" "" day ${HYDRODIP_DATE})
  string(APPEND CPACK_DEBIAN_PACKAGE_VERSION "+git${day}.${commit}")
endif()
set(deb_version ${CPACK_DEBIAN_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# CMake 3.25 knows no variable for Multi-Arch; a section may have another line behind it.
set(same "\nMulti-Arch: same")
set(foreign "\nMulti-Arch: foreign")

# What every package has to have, in a folder of its name.
execute_process(COMMAND date -R -u -d ${HYDRODIP_DATE} OUTPUT_VARIABLE deb_date
                OUTPUT_STRIP_TRAILING_WHITESPACE)
file(WRITE ${CMAKE_BINARY_DIR}/deb/changelog
     "hydrodip (${deb_version}) unstable; urgency=medium\n\n"
     "  * Version ${HYDRODIP_VERSION_TEXT}; what changed and why stands in CHANGELOG.md.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${deb_date}\n")
execute_process(COMMAND gzip -9nkf ${CMAKE_BINARY_DIR}/deb/changelog)
file(RENAME ${CMAKE_BINARY_DIR}/deb/changelog.gz ${CMAKE_BINARY_DIR}/deb/changelog.Debian.gz)

# Lines of at most 76 characters, as a control file has them.
function(hydrodip_wrap result text)
  string(REPLACE " " ";" words "${text}")
  set(line "")
  set(lines "")
  foreach(word IN LISTS words)
    string(LENGTH "${line} ${word}" length)
    if(line STREQUAL "")
      set(line ${word})
    elseif(length GREATER 76)
      string(APPEND lines "${line}\n ")
      set(line ${word})
    else()
      string(APPEND line " ${word}")
    endif()
  endforeach()
  set(${result} "${lines}${line}" PARENT_SCOPE)
endfunction()

# hydrodip_deb(COMPONENT PACKAGE SUMMARY DESCRIPTION...): a paragraph of the description each.
function(hydrodip_deb component package summary)
  string(TOUPPER ${component} upper)
  set(text "")
  set(between "")
  foreach(paragraph IN LISTS ARGN)
    hydrodip_wrap(paragraph "${paragraph}")
    string(APPEND text "${between}${paragraph}")
    set(between "\n \n ")
  endforeach()
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  install(FILES ${CMAKE_SOURCE_DIR}/packaging/deb/copyright ${CMAKE_BINARY_DIR}/deb/changelog.Debian.gz
          DESTINATION share/doc/${package} COMPONENT ${component})
  # For all packages, and for this one.
  set(overrides "")
  foreach(file lintian-overrides ${component}.lintian-overrides)
    if(EXISTS ${CMAKE_SOURCE_DIR}/packaging/deb/${file})
      file(READ ${CMAKE_SOURCE_DIR}/packaging/deb/${file} text)
      string(APPEND overrides "${text}")
    endif()
  endforeach()
  string(REPLACE @PACKAGE@ ${package} overrides "${overrides}")
  file(WRITE ${CMAKE_BINARY_DIR}/deb/overrides/${package} "${overrides}")
  install(FILES ${CMAKE_BINARY_DIR}/deb/overrides/${package} DESTINATION share/lintian/overrides
          COMPONENT ${component})
endfunction()

set(CPACK_COMPONENTS_ALL "")
set(what "hydrodip is to hydro-dipping what a slicer is to 3D printing: a textured model goes in, and out comes a film image that, printed at true size on PVA film and dipped as told, puts every colour where the model has it.")

hydrodip_deb(program hydrodip "film images for hydro-dipping, from textured models" "${what}"
  "It simulates the floating film as the object comes down through it and draws the image backwards from that. It also finds the best way to hold the object, plans several dips, puts pictures on models that have no texture, and leads through the dip at the bath.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "fonts-dejavu-core, xdg-utils")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "hydrodip-doc, libgs-common")

set(so libhydrodip${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
hydrodip_deb(library ${so} "film images for hydro-dipping: the library" "${what}"
  "This package has the shared library.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION "libs${same}")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/deb_finish.cmake)

hydrodip_deb(dev libhydrodip-dev "film images for hydro-dipping: headers of the library" "${what}"
  "This package has the headers, and what CMake and pkg-config need to find the library.")
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION "libdevel${same}")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${so} (= ${deb_version}), libeigen3-dev")

# The site, if ./dev docs has made it.
if(EXISTS ${CMAKE_SOURCE_DIR}/build/docs/index.html)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/build/docs/ DESTINATION share/doc/hydrodip-doc/html
          COMPONENT doc)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/examples DESTINATION share/doc/hydrodip-doc COMPONENT doc)
  hydrodip_deb(doc hydrodip-doc "film images for hydro-dipping: guides and reference" "${what}"
    "This package has the guides for makers, shops and researchers, the file formats with their schemas, the library's reference, and examples.")
  set(CPACK_DEBIAN_DOC_PACKAGE_SECTION "doc${foreign}")
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
endif()

# The Python module, where it is built: python/CMakeLists.txt installs it as component `python` and says
# for which Python it is.
if(TARGET hydrodip_python)
  math(EXPR python_next "${HYDRODIP_PYTHON_MINOR} + 1")
  hydrodip_deb(python python3-hydrodip "film images for hydro-dipping: Python module" "${what}"
    "This package has the Python module: it simulates dips, designs film images and plans how to hold the object, with numpy arrays in and out.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${HYDRODIP_PYTHON_MINOR}), python3 (<< 3.${python_next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-meshio")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/deb/python/postinst
                                                ${CMAKE_SOURCE_DIR}/packaging/deb/python/prerm)
endif()

include(CPack)
