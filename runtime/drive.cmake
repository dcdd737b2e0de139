# The drive: parameters, control logic, setpoints, faults. It knows nothing of buses.
ipos_layer(drive FOLDERS runtime/drive
           SOURCES drive/parameters.cpp drive/error_memory.cpp drive/settings.cpp drive/terminals.cpp drive/process_data.cpp
                   drive/fault_state.cpp drive/link_watch.cpp drive/control.cpp drive/setpoint.cpp
                   drive/setpoint_memory.cpp drive/outputs.cpp drive/scope.cpp drive/drive.cpp drive/drive_decisions.cpp drive/drive_orders.cpp
                   drive/drive_display.cpp drive/analog_outputs.cpp
           USES stdlib motion LIBS fmt::fmt)
set_target_properties(ipos_drive PROPERTIES UNITY_BUILD OFF)  # sources of it have names that are alike
