# The planner of bus lines: looks at a plant from outside.
ipos_layer(plan
  FOLDERS runtime/plan
  SOURCES plan/response_time.cpp plan/roster.cpp plan/names.cpp plan/identifiers.cpp plan/telegrams.cpp
          plan/check_cable.cpp plan/check_profile.cpp plan/check_objects.cpp plan/serial_lines.cpp plan/plan.cpp
  USES runtime
  LIBS fmt::fmt)
ipos_not_hot(ipos_plan)
