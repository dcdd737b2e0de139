# What `cmake --install` puts where: the libraries with their headers, the CMake package and the pkg-config files,
# and the command line tool. CPack makes a Debian package of it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS ipos_embedded ipos_shared ipos_compile ipos_plant EXPORT ipos
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/embed/include/ ${ipos_written_headers}/ ${PROJECT_SOURCE_DIR}/runtime/library/include/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS ipos RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ipos_fmu LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/ipos)  # for `ipos fmu`
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# As Debian's policy wants them (12.5, 12.7): licences of all that is in the package, and what has changed.
ipos_notices(notices IN deb page plot extension)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/copyright CONTENT "@notices@" @ONLY)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/packaging/debian/changelog
                OUTPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${PROJECT_BINARY_DIR}/debian/copyright ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The manual page and the completions, written by the program itself.
set(shell ${PROJECT_BINARY_DIR}/shell)
file(MAKE_DIRECTORY ${shell})
add_custom_command(OUTPUT ${shell}/ipos.1.gz ${shell}/ipos ${shell}/_ipos ${shell}/ipos.fish
  COMMAND ipos man | gzip -9n >${shell}/ipos.1.gz
  COMMAND ipos completion bash >${shell}/ipos
  COMMAND ipos completion zsh >${shell}/_ipos
  COMMAND ipos completion fish >${shell}/ipos.fish
  DEPENDS ipos COMMENT "Writing the manual page and the completions")
add_custom_target(ipos_shell_files ALL DEPENDS ${shell}/ipos.1.gz)
install(FILES ${shell}/ipos.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${shell}/ipos DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${shell}/_ipos DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${shell}/ipos.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# The Wireshark dissector, also written by the program, where Wireshark looks: below /usr, and below ~/.local.
set(dissector ${PROJECT_BINARY_DIR}/wireshark/movilink.lua)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/wireshark)
add_custom_command(OUTPUT ${dissector} COMMAND ipos bus dissector -o ${dissector} DEPENDS ipos
                   COMMENT "Writing the dissector for Wireshark")
add_custom_target(ipos_dissector ALL DEPENDS ${dissector})
install(FILES ${dissector} DESTINATION ${CMAKE_INSTALL_LIBDIR}/wireshark/plugins)

# The VS Code extension, where somebody has built it: that takes npm and its registry.
set(extension ${PROJECT_SOURCE_DIR}/tools/vscode)
file(GLOB_RECURSE extension_sources CONFIGURE_DEPENDS ${extension}/src/* ${extension}/*.json)
list(FILTER extension_sources EXCLUDE REGEX "/(node_modules|out)/")
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/vscode/ipos.vsix
  COMMAND ${extension}/pack.sh ${PROJECT_BINARY_DIR}/vscode/ipos.vsix
  DEPENDS ${extension_sources} ${extension}/pack.sh COMMENT "Packing the VS Code extension")
add_custom_target(ipos_vsix DEPENDS ${PROJECT_BINARY_DIR}/vscode/ipos.vsix)
install(FILES ${PROJECT_BINARY_DIR}/vscode/ipos.vsix DESTINATION ${CMAKE_INSTALL_DATADIR}/ipos OPTIONAL)

# The Python package, where Debian's Python looks; it finds libipos_plant by the loader. What tells python-can and pytest of it
# stands beside it.
set(python_dir lib/python3/dist-packages)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/ipos DESTINATION ${python_dir}
        FILES_MATCHING PATTERN *.py PATTERN py.typed PATTERN __pycache__ EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/ipos-${PROJECT_VERSION}.dist-info DESTINATION ${python_dir})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ipos)
install(EXPORT ipos NAMESPACE ipos:: FILE iposTargets.cmake DESTINATION ${package_dir})
file(WRITE ${PROJECT_BINARY_DIR}/iposConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/iposTargets.cmake)\n")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/iposConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/iposConfig.cmake ${PROJECT_BINARY_DIR}/iposConfigVersion.cmake
        DESTINATION ${package_dir})

# libipos_compile.so finds libipos.so beside itself.
set_target_properties(ipos_compile PROPERTIES INSTALL_RPATH "$ORIGIN")

# Found from where the file lies, so that an installed tree can be moved. Where the loader does not look by itself,
# programs get the run path; that depends on the prefix, which is known when it is installed.
file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
foreach(part ipos ipos_compile ipos_plant)
  set(requires "")
  set(defines " -DIPOS_VARIABLES=${IPOS_VARIABLES}")
  if(part STREQUAL ipos_plant)
    set(defines "")
  endif()
  if(part STREQUAL ipos_compile)
    set(requires "Requires: ipos\n")
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/${part}.pc.in "prefix=\${pcfiledir}/${up}
libdir=\${pcfiledir}/..
Name: ${part}
Description: ${PROJECT_DESCRIPTION}
Version: ${PROJECT_VERSION}
${requires}Cflags: -I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}${defines}
Libs: -L\${libdir} -l${part}@run_path@
")
  install(CODE "
    set(run_path \"\")
    if(NOT CMAKE_INSTALL_PREFIX MATCHES \"^/usr(/local)?/?$\")
      set(run_path \" -Wl,-rpath,\\\${libdir}\")
    endif()
    configure_file(${PROJECT_BINARY_DIR}/${part}.pc.in ${PROJECT_BINARY_DIR}/${part}.pc @ONLY)")
  install(FILES ${PROJECT_BINARY_DIR}/${part}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ipos)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PRIVATE_SHLIBDEPS_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_PACKAGE_CONTACT "the ipos contributors <ipos@example.org>")
set(CPACK_PACKAGE_DESCRIPTION "Compiles, runs and tests programs for IPOSplus-style drives without
a drive: it simulates the drives, their inputs and the buses between them,
and shows them in a browser. With the C libraries of the machine, of the
compiler and of whole plants, and with the Python package.")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3:any")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/debian/triggers)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
include(CPack)
