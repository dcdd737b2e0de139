# What brings the lines of a plant and real ports together.
ipos_layer(plant_port FOLDERS runtime/plant_port SOURCES plant_port/join.cpp USES runtime os_port LIBS fmt::fmt)
ipos_not_hot(ipos_plant_port)
