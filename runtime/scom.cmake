# The variable telegrams of a unit: as data without heap (object_table), which firmware has, too, and on a simulated line.
ipos_layer(scom FOLDERS runtime/scom SOURCES scom/object_table.cpp scom/variable_objects.cpp USES bus_can bus_movilink clock stdlib LIBS fmt::fmt)
