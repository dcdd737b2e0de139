# Toolchain of the Cortex-M presets: Debian's gcc-arm-none-eabi with newlib. IPOS_CORE is m0, m3 or m4f.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # a program would need a linker script
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES IPOS_CORE)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)

set(core_m0 -mcpu=cortex-m0plus)
set(core_m3 -mcpu=cortex-m3)
set(core_m4f "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
# For each file the stack its functions use, and who calls whom: size_report.py adds it up.
set(flags "${core_${IPOS_CORE}} -mthumb -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su")
set(CMAKE_C_FLAGS_INIT "${flags}")
set(CMAKE_CXX_FLAGS_INIT "${flags} -fno-exceptions -fno-rtti")
