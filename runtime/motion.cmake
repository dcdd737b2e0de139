# Ramps, brake, motor and load of one axis. Pure arithmetic on integers; it knows neither drive nor bus.
# A part is what time passes through.
ipos_layer(part FOLDERS runtime/part)
ipos_layer(motion FOLDERS runtime/motion
           SOURCES motion/machine_data.cpp motion/ramp.cpp motion/brake_sequence.cpp motion/shaft.cpp motion/power_section.cpp
                   motion/axis.cpp motion/axis_in_detail.cpp motion/load_torque.cpp motion/voltage_control.cpp motion/speed_control.cpp
                   motion/second_mass.cpp motion/motor.cpp
           USES part)
# Doubles give the same on every processor: no product is joined to a sum.
target_compile_options(ipos_motion PRIVATE -ffp-contract=off)
