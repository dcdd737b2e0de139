# What `cmake --install` puts where in a build for Windows: the plant as a DLL, with its import library for mingw, its list of
# functions (of which `lib /def:` makes one for Microsoft's linker), its header and the CMake package.
include(CMakePackageConfigHelpers)
install(TARGETS ipos_plant EXPORT ipos RUNTIME DESTINATION bin ARCHIVE DESTINATION lib INCLUDES DESTINATION include)
install(TARGETS ipos_fmu RUNTIME DESTINATION bin OPTIONAL)  # for `ipos fmu`
install(FILES ${PROJECT_BINARY_DIR}/lib/ipos_plant.def DESTINATION lib)
install(FILES ${PROJECT_SOURCE_DIR}/runtime/library/include/ipos_plant.h DESTINATION include)
ipos_notices(notices IN windows-library)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/lib/NOTICES.txt CONTENT "@notices@" @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lib/NOTICES.txt DESTINATION .)

set(package_dir lib/cmake/ipos)
install(EXPORT ipos NAMESPACE ipos:: FILE iposTargets.cmake DESTINATION ${package_dir})
file(WRITE ${PROJECT_BINARY_DIR}/iposConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/iposTargets.cmake)\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/iposConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/iposConfig.cmake ${PROJECT_BINARY_DIR}/iposConfigVersion.cmake DESTINATION ${package_dir})
