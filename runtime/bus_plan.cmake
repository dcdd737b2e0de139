# The planner of bus lines: looks at a plant from outside.
ipos_layer(bus_plan
  FOLDERS runtime/bus_plan
  SOURCES bus_plan/response_time.cpp bus_plan/roster.cpp bus_plan/names.cpp bus_plan/identifiers.cpp bus_plan/telegrams.cpp bus_plan/canopen_messages.cpp
          bus_plan/check_cable.cpp bus_plan/check_octet_faults.cpp bus_plan/check_profile.cpp bus_plan/check_objects.cpp bus_plan/serial_lines.cpp bus_plan/profibus_lines.cpp bus_plan/plan.cpp
  USES runtime
  LIBS fmt::fmt)
ipos_not_hot(ipos_bus_plan)
