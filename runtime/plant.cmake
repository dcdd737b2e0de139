# A plant: stations on their lines, and their surroundings, on one clock.
find_package(Threads REQUIRED)
ipos_layer(runtime
  FOLDERS runtime/plant
  SOURCES plant/belt.cpp plant/surroundings.cpp plant/machines.cpp plant/plant.cpp plant/start_checks.cpp plant/all_mistakes.cpp plant/actions.cpp
          plant/trace_hash.cpp plant/islands.cpp plant/crew.cpp
  USES signals station plant_file unit vm image bus scom drive positioning motion storage stdlib
  LIBS fmt::fmt Threads::Threads)
ipos_batches(ipos_runtime SIZE 20 HOT plant/surroundings.cpp plant/plant.cpp)
