# For builds that Debian has no packages of libraries for. It has {fmt}, CLI11, nlohmann-json, toml++ and tl::expected for
# Linux only, but all of them work out of their headers alone. Those headers, and no others of /usr/include, are linked into a
# folder of the build tree.
set(headers ${PROJECT_BINARY_DIR}/headers)
foreach(header fmt CLI nlohmann toml++ tl ${more_headers} linux/can/error.h)  # the last: numbers of CAN errors, which a record of a line names
  find_path(found_${header} ${header} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
  get_filename_component(folder ${headers}/${header} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK ${found_${header}}/${header} ${headers}/${header} SYMBOLIC)
endforeach()

# find_package() takes these in place of the packages, in any version.
foreach(row fmt=fmt::fmt CLI11=CLI11::CLI11 nlohmann_json=nlohmann_json::nlohmann_json tomlplusplus=tomlplusplus::tomlplusplus
            Boost=Boost::headers)
  string(REPLACE "=" ";" row ${row})
  list(POP_FRONT row package)
  add_library(${row} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${row} INTERFACE ${headers})
  string(TOLOWER ${package} name)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}-config.cmake "")
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}-config-version.cmake "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
endforeach()
include_directories(SYSTEM ${headers})
