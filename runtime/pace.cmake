# Decides which milliseconds are executed in their turn, later, or many at once. It knows time and nothing else.
ipos_layer(pace FOLDERS runtime/pace SOURCES pace/pacer.cpp USES clock part)
