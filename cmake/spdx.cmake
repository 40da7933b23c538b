# Writes OUTPUT: what the program holds of others' works, as SPDX 2.3. The page's packages come from
# the lock file, what is compiled in from the list here, with the versions that lie on this machine.
cmake_minimum_required(VERSION 3.25)

# Headers and static libraries of Debian that end up in the program: package, SPDX licence, what for.
set(compiled_in
    "libeigen3-dev;MPL-2.0;https://eigen.tuxfamily.org;headers: linear algebra"
    "libcli11-dev;BSD-3-Clause;https://github.com/CLIUtils/CLI11;headers: the command line"
    "libcpp-httplib-dev;MIT;https://github.com/yhirose/cpp-httplib;headers: the studio's server"
    "nlohmann-json3-dev;MIT;https://github.com/nlohmann/json;headers: JSON"
    "libtomlplusplus-dev;MIT;https://github.com/marzer/tomlplusplus;headers: TOML"
    "libfmt-dev;MIT;https://github.com/fmtlib/fmt;headers: formatting")

function(spdx_id result name)
  string(REGEX REPLACE "[^A-Za-z0-9.-]" "-" id "SPDXRef-${name}")
  set(${result} ${id} PARENT_SCOPE)
endfunction()

set(packages "")
set(relations "")
# add(NAME VERSION LICENSE LOCATION COMMENT [EXTRA]): EXTRA are further members.
function(add name version license location comment extra)
  spdx_id(id ${name})
  list(APPEND packages "    {
      \"SPDXID\": \"${id}\",
      \"name\": \"${name}\",
      \"versionInfo\": \"${version}\",
      \"downloadLocation\": \"${location}\",
      \"licenseConcluded\": \"${license}\",
      \"licenseDeclared\": \"${license}\",
      \"copyrightText\": \"NOASSERTION\",
      \"filesAnalyzed\": false,${extra}
      \"comment\": \"${comment}\"
    }")
  set(packages "${packages}" PARENT_SCOPE)
endfunction()
function(relate from type to)
  list(APPEND relations "    {\"spdxElementId\": \"${from}\", \"relationshipType\": \"${type}\", \"relatedSpdxElement\": \"${to}\"}")
  set(relations "${relations}" PARENT_SCOPE)
endfunction()

add(hydrodip ${VERSION} MIT NOASSERTION "this program" "")
relate(SPDXRef-DOCUMENT DESCRIBES SPDXRef-hydrodip)

list(LENGTH compiled_in count)
math(EXPR last "${count} - 4")
foreach(i RANGE 0 ${last} 4)
  list(SUBLIST compiled_in ${i} 4 entry)
  list(GET entry 0 name)
  list(GET entry 1 license)
  list(GET entry 2 location)
  list(GET entry 3 comment)
  execute_process(COMMAND dpkg-query -W "-f=\${Version}" ${name} OUTPUT_VARIABLE version
                  RESULT_VARIABLE code ERROR_QUIET)
  if(NOT code EQUAL 0)
    set(version NOASSERTION)
  endif()
  add(${name} ${version} ${license} ${location} "${comment}" "")
  relate(SPDXRef-hydrodip CONTAINS SPDXRef-${name})
endforeach()

if(VIEWER)
  file(GLOB locks ${SOURCE}/src/*/*/package-lock.json)
  set(seen "")
  foreach(lock IN LISTS locks)
    file(READ ${lock} text)
    string(JSON count LENGTH ${text} packages)
    math(EXPR last "${count} - 1")
    foreach(i RANGE ${last})
      string(JSON path MEMBER ${text} packages ${i})
      string(JSON dev ERROR_VARIABLE none GET ${text} packages ${path} dev)
      if(path STREQUAL "" OR dev STREQUAL "ON") # the page itself; what only tests use
        continue()
      endif()
      string(REGEX REPLACE "^.*node_modules/" "" name ${path})
      string(JSON version GET ${text} packages ${path} version)
      string(JSON license ERROR_VARIABLE none GET ${text} packages ${path} license)
      string(JSON integrity ERROR_VARIABLE none GET ${text} packages ${path} integrity)
      if("${name}@${version}" IN_LIST seen)
        continue()
      endif()
      list(APPEND seen "${name}@${version}")
      string(REPLACE "@" "%40" purl ${name})
      add(${name} ${version} ${license} NOASSERTION "npm: in the pages that the program writes or serves, ${integrity}"
          "
      \"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\", \"referenceLocator\": \"pkg:npm/${purl}@${version}\"}],")
      spdx_id(id ${name})
      relate(SPDXRef-hydrodip CONTAINS ${id})
    endforeach()
  endforeach()
endif()

list(JOIN packages ",\n" packages)
list(JOIN relations ",\n" relations)
file(WRITE ${OUTPUT} "{
  \"spdxVersion\": \"SPDX-2.3\",
  \"dataLicense\": \"CC0-1.0\",
  \"SPDXID\": \"SPDXRef-DOCUMENT\",
  \"name\": \"hydrodip-${VERSION}\",
  \"documentNamespace\": \"urn:hydrodip:spdx:${VERSION}\",
  \"creationInfo\": {\"created\": \"${DATE}T00:00:00Z\", \"creators\": [\"Tool: cmake/spdx.cmake\"]},
  \"packages\": [
${packages}
  ],
  \"relationships\": [
${relations}
  ]
}
")
