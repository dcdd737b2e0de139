# Foreign FMUs as machines of a plant, on Linux. Each runs in a process of its own, whose small program is embedded.
if(CMAKE_SYSTEM_NAME STREQUAL Linux AND NOT IPOS_LIBRARY_ONLY)
  find_package(EXPAT REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(Threads REQUIRED)
  set(host ${CMAKE_CURRENT_SOURCE_DIR}/fmi_import/host)
  add_executable(ipos_fmu_host ${host}/host.c ${host}/calls.c ${host}/words.c)
  target_compile_options(ipos_fmu_host PRIVATE -O2 -Wall -Wextra -Wshadow -Werror)
  set_target_properties(ipos_fmu_host PROPERTIES UNITY_BUILD OFF)  # C has no namespaces
  target_link_options(ipos_fmu_host PRIVATE -s)
  target_link_libraries(ipos_fmu_host PRIVATE Threads::Threads ${CMAKE_DL_LIBS})
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/fmu_host)
  set_target_properties(ipos_fmu_host PROPERTIES C_STANDARD 11 C_EXTENSIONS ON RUNTIME_OUTPUT_DIRECTORY ${folder})
  ipos_layer(fmi_import
    FOLDERS runtime/fmi_import
    SOURCES fmi_import/archive.cpp fmi_import/description.cpp fmi_import/fmu_model.cpp fmi_import/host_process.cpp
    USES signals plant_file stdlib
    LIBS fmt::fmt EXPAT::EXPAT ZLIB::ZLIB)
  set_source_files_properties(fmi_import/host_process.cpp PROPERTIES
    COMPILE_DEFINITIONS IPOS_FMU_HOST="${folder}/ipos_fmu_host" OBJECT_DEPENDS ${folder}/ipos_fmu_host
    SKIP_UNITY_BUILD_INCLUSION ON)
  ipos_not_hot(ipos_fmi_import)
endif()
