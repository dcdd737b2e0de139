# The target ipos_static: build/*/static/ipos, the command line tool with all it needs inside, for any Linux of the same
# processor. Debian has {fmt} and toml++ as shared objects only; tools/static compiles them out of their headers.
#
# It is the objects and libraries of `ipos` once more, linked without any shared object, so it costs no compilation.
foreach(library asmjit edit tinfo bsd md z expat)
  find_library(IPOS_STATIC_${library} lib${library}.a)
endforeach()
set(IPOS_STATIC OFF)
if(CMAKE_SYSTEM_NAME STREQUAL Linux AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT IPOS_SANITIZE AND NOT IPOS_COVERAGE
   AND EXISTS /usr/include/fmt/format-inl.h)
  set(IPOS_STATIC ON)
endif()
if(TARGET asmjit::asmjit AND NOT IPOS_STATIC_asmjit)
  set(IPOS_STATIC OFF)
endif()

if(IPOS_STATIC)
  add_library(ipos_static_parts OBJECT ${PROJECT_SOURCE_DIR}/tools/static/fmt.cpp
                                       ${PROJECT_SOURCE_DIR}/tools/static/toml.cpp)
  target_compile_definitions(ipos_static_parts PRIVATE TOML_HEADER_ONLY=0)
  set(archives "")
  foreach(folder stdlib vm compiler runtime tools)
    get_property(targets DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type STREQUAL STATIC_LIBRARY AND NOT target STREQUAL ipos_embedded)  # which is the VM once more
        list(APPEND archives $<TARGET_FILE:${target}>)
      endif()
    endforeach()
  endforeach()
  set(others "")
  foreach(library asmjit edit tinfo bsd md z expat)
    if(IPOS_STATIC_${library})
      list(APPEND others ${IPOS_STATIC_${library}})
    endif()
  endforeach()
  set(out ${PROJECT_BINARY_DIR}/static/ipos)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/static)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_CXX_COMPILER} -static -s -o ${out} $<TARGET_OBJECTS:ipos> $<TARGET_OBJECTS:ipos_static_parts>
            -Wl,--start-group ${archives} ${others} -Wl,--end-group
    DEPENDS ipos ipos_static_parts COMMAND_EXPAND_LISTS VERBATIM COMMENT "Linking the static binary static/ipos")
  add_custom_target(ipos_static DEPENDS ${out})
endif()
