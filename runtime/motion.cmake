# Ramps, brake, motor and load of one axis. Pure arithmetic on integers; it knows neither drive nor bus.
# A part is what time passes through.
ipos_layer(part FOLDERS runtime/part)
ipos_layer(motion FOLDERS runtime/motion
           SOURCES motion/machine_data.cpp motion/ramp.cpp motion/brake_sequence.cpp motion/shaft.cpp motion/power_section.cpp
                   motion/axis.cpp
           USES part)
