# The variable telegrams of a unit as data, without heap: for the simulated station and for firmware.
ipos_layer(scom FOLDERS runtime/scom SOURCES scom/object_table.cpp USES bus stdlib)
