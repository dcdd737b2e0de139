# Ramps, brake, motor and load of one axis. Pure arithmetic on integers; it knows neither drive nor bus.
# With it what a part is that time passes through (runtime/pace).
ipos_layer(motion FOLDERS runtime/motion runtime/pace
           SOURCES motion/machine_data.cpp motion/ramp.cpp motion/brake_sequence.cpp motion/shaft.cpp motion/power_section.cpp
                   motion/axis.cpp)
