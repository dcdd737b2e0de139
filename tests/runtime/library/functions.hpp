// ipos_plant.h with its calls counted: at the end of the test program it is known which functions the tests have called and
// which statuses came (functions_test.cpp). Tests include this in place of ipos_plant.h.
#pragma once

#include <ipos_plant.h>

#include <array>
#include <atomic>
#include <string_view>
#include <type_traits>

namespace ipos::tests {

inline constexpr std::string_view kFunctions[] = {
    "ipos_plant_version", "ipos_plant_mistake_at", "ipos_plant_adopt", "ipos_plant_status_text",
    "ipos_plant_open", "ipos_plant_close", "ipos_plant_message", "ipos_plant_mistakes",
    "ipos_plant_duration", "ipos_plant_time", "ipos_plant_run", "ipos_plant_run_to_frame",
    "ipos_plant_run_until", "ipos_plant_station_at", "ipos_plant_station", "ipos_plant_ideal_motor", "ipos_plant_power",
    "ipos_plant_program", "ipos_plant_drive_fault", "ipos_plant_reset_fault", "ipos_plant_why",
    "ipos_plant_find", "ipos_plant_signal_info_of", "ipos_plant_name_at", "ipos_plant_read",
    "ipos_plant_read_many", "ipos_plant_read_text", "ipos_plant_write", "ipos_plant_write_text",
    "ipos_plant_force", "ipos_plant_force_text", "ipos_plant_release", "ipos_plant_bus_at",
    "ipos_plant_bus", "ipos_plant_bus_load", "ipos_plant_join", "ipos_plant_send", "ipos_plant_receive",
    "ipos_plant_node_name", "ipos_plant_serial_send", "ipos_plant_serial_receive", "ipos_plant_line_fault", "ipos_plant_fms",
    "ipos_plant_parameter_index", "ipos_plant_parameter_text", "ipos_plant_parameter_value",
    "ipos_plant_return_code", "ipos_plant_unit_name", "ipos_plant_unit_signs", "ipos_plant_journal_at", "ipos_plant_save", "ipos_plant_restore",
    "ipos_plant_restart", "ipos_plant_replay", "ipos_plant_trace_hash",
};

consteval size_t function_number(std::string_view name) {
  size_t number = 0;
  while (kFunctions[number] != name) ++number;
  return number;
}

// Without locks and memory, as calls come from many threads and with memory that fails.
inline std::array<std::atomic<bool>, std::size(kFunctions)> functions_called{};
inline std::array<std::atomic<bool>, 32> statuses_seen{};

template <size_t kNumber, typename Result>
Result called(Result result) {
  functions_called[kNumber].store(true, std::memory_order_relaxed);
  if constexpr (std::is_same_v<Result, ipos_plant_status>)
    statuses_seen[static_cast<size_t>(result) % statuses_seen.size()].store(true, std::memory_order_relaxed);
  return result;
}

}  // namespace ipos::tests

// The name in brackets is the function, as it is not followed by its arguments.
#define IPOS_CALLED(function, ...) \
  ::ipos::tests::called< ::ipos::tests::function_number(#function)>((function)(__VA_ARGS__))
#define ipos_plant_version(...) IPOS_CALLED(ipos_plant_version, __VA_ARGS__)
#define ipos_plant_mistake_at(...) IPOS_CALLED(ipos_plant_mistake_at, __VA_ARGS__)
#define ipos_plant_adopt(...) IPOS_CALLED(ipos_plant_adopt, __VA_ARGS__)
#define ipos_plant_status_text(...) IPOS_CALLED(ipos_plant_status_text, __VA_ARGS__)
#define ipos_plant_open(...) IPOS_CALLED(ipos_plant_open, __VA_ARGS__)
#define ipos_plant_close(...) IPOS_CALLED(ipos_plant_close, __VA_ARGS__)
#define ipos_plant_message(...) IPOS_CALLED(ipos_plant_message, __VA_ARGS__)
#define ipos_plant_mistakes(...) IPOS_CALLED(ipos_plant_mistakes, __VA_ARGS__)
#define ipos_plant_duration(...) IPOS_CALLED(ipos_plant_duration, __VA_ARGS__)
#define ipos_plant_time(...) IPOS_CALLED(ipos_plant_time, __VA_ARGS__)
#define ipos_plant_run(...) IPOS_CALLED(ipos_plant_run, __VA_ARGS__)
#define ipos_plant_run_to_frame(...) IPOS_CALLED(ipos_plant_run_to_frame, __VA_ARGS__)
#define ipos_plant_run_until(...) IPOS_CALLED(ipos_plant_run_until, __VA_ARGS__)
#define ipos_plant_station_at(...) IPOS_CALLED(ipos_plant_station_at, __VA_ARGS__)
#define ipos_plant_station(...) IPOS_CALLED(ipos_plant_station, __VA_ARGS__)
#define ipos_plant_ideal_motor(...) IPOS_CALLED(ipos_plant_ideal_motor, __VA_ARGS__)
#define ipos_plant_power(...) IPOS_CALLED(ipos_plant_power, __VA_ARGS__)
#define ipos_plant_program(...) IPOS_CALLED(ipos_plant_program, __VA_ARGS__)
#define ipos_plant_drive_fault(...) IPOS_CALLED(ipos_plant_drive_fault, __VA_ARGS__)
#define ipos_plant_reset_fault(...) IPOS_CALLED(ipos_plant_reset_fault, __VA_ARGS__)
#define ipos_plant_why(...) IPOS_CALLED(ipos_plant_why, __VA_ARGS__)
#define ipos_plant_find(...) IPOS_CALLED(ipos_plant_find, __VA_ARGS__)
#define ipos_plant_signal_info_of(...) IPOS_CALLED(ipos_plant_signal_info_of, __VA_ARGS__)
#define ipos_plant_name_at(...) IPOS_CALLED(ipos_plant_name_at, __VA_ARGS__)
#define ipos_plant_read(...) IPOS_CALLED(ipos_plant_read, __VA_ARGS__)
#define ipos_plant_read_many(...) IPOS_CALLED(ipos_plant_read_many, __VA_ARGS__)
#define ipos_plant_read_text(...) IPOS_CALLED(ipos_plant_read_text, __VA_ARGS__)
#define ipos_plant_write(...) IPOS_CALLED(ipos_plant_write, __VA_ARGS__)
#define ipos_plant_write_text(...) IPOS_CALLED(ipos_plant_write_text, __VA_ARGS__)
#define ipos_plant_force(...) IPOS_CALLED(ipos_plant_force, __VA_ARGS__)
#define ipos_plant_force_text(...) IPOS_CALLED(ipos_plant_force_text, __VA_ARGS__)
#define ipos_plant_release(...) IPOS_CALLED(ipos_plant_release, __VA_ARGS__)
#define ipos_plant_bus_at(...) IPOS_CALLED(ipos_plant_bus_at, __VA_ARGS__)
#define ipos_plant_bus(...) IPOS_CALLED(ipos_plant_bus, __VA_ARGS__)
#define ipos_plant_bus_load(...) IPOS_CALLED(ipos_plant_bus_load, __VA_ARGS__)
#define ipos_plant_join(...) IPOS_CALLED(ipos_plant_join, __VA_ARGS__)
#define ipos_plant_send(...) IPOS_CALLED(ipos_plant_send, __VA_ARGS__)
#define ipos_plant_receive(...) IPOS_CALLED(ipos_plant_receive, __VA_ARGS__)
#define ipos_plant_node_name(...) IPOS_CALLED(ipos_plant_node_name, __VA_ARGS__)
#define ipos_plant_serial_send(...) IPOS_CALLED(ipos_plant_serial_send, __VA_ARGS__)
#define ipos_plant_serial_receive(...) IPOS_CALLED(ipos_plant_serial_receive, __VA_ARGS__)
#define ipos_plant_fms(...) IPOS_CALLED(ipos_plant_fms, __VA_ARGS__)
#define ipos_plant_line_fault(...) IPOS_CALLED(ipos_plant_line_fault, __VA_ARGS__)
#define ipos_plant_parameter_index(...) IPOS_CALLED(ipos_plant_parameter_index, __VA_ARGS__)
#define ipos_plant_parameter_text(...) IPOS_CALLED(ipos_plant_parameter_text, __VA_ARGS__)
#define ipos_plant_parameter_value(...) IPOS_CALLED(ipos_plant_parameter_value, __VA_ARGS__)
#define ipos_plant_return_code(...) IPOS_CALLED(ipos_plant_return_code, __VA_ARGS__)
#define ipos_plant_unit_name(...) IPOS_CALLED(ipos_plant_unit_name, __VA_ARGS__)
#define ipos_plant_unit_signs(...) IPOS_CALLED(ipos_plant_unit_signs, __VA_ARGS__)
#define ipos_plant_journal_at(...) IPOS_CALLED(ipos_plant_journal_at, __VA_ARGS__)
#define ipos_plant_save(...) IPOS_CALLED(ipos_plant_save, __VA_ARGS__)
#define ipos_plant_restore(...) IPOS_CALLED(ipos_plant_restore, __VA_ARGS__)
#define ipos_plant_restart(...) IPOS_CALLED(ipos_plant_restart, __VA_ARGS__)
#define ipos_plant_replay(...) IPOS_CALLED(ipos_plant_replay, __VA_ARGS__)
#define ipos_plant_trace_hash(...) IPOS_CALLED(ipos_plant_trace_hash, __VA_ARGS__)
