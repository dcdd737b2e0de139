# What lies beside ipos.c for build systems of firmware (embed/firmware): manifests for Zephyr, PlatformIO and CMSIS, as a
# folder, an archive and a pack with the same bytes in each build.
set(beside ${PROJECT_SOURCE_DIR}/embed/firmware)
set(files ipos.c ipos.h LICENSE README.md library.json ipos.pdsc zephyr/module.yml zephyr/Kconfig zephyr/CMakeLists.txt)
foreach(name README.md zephyr/module.yml zephyr/Kconfig zephyr/CMakeLists.txt)
  configure_file(${beside}/${name} ${ipos_firmware}/${name} COPYONLY)
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/LICENSE ${ipos_firmware}/LICENSE COPYONLY)
foreach(name library.json ipos.pdsc)
  configure_file(${beside}/${name}.in ${ipos_firmware}/${name} @ONLY)
endforeach()

set(archive ${PROJECT_BINARY_DIR}/ipos-firmware-${PROJECT_VERSION}.zip)
set(pack ${PROJECT_BINARY_DIR}/ipos.ipos.${PROJECT_VERSION}.pack)  # vendor, name, version
foreach(package ${archive} ${pack})
  add_custom_command(OUTPUT ${package}
    COMMAND ${CMAKE_COMMAND} -E tar cf ${package} --format=zip "--mtime=2026-01-01 00:00:00" ${files}
    DEPENDS ipos_firmware_file ${ipos_firmware}/ipos.c WORKING_DIRECTORY ${ipos_firmware} VERBATIM
    COMMENT "Packing ${package}")
endforeach()
add_custom_target(ipos_firmware_package DEPENDS ${archive} ${pack})
