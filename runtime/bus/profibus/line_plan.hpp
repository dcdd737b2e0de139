// A PROFIBUS line on paper: what is wrong with it before it is built. Cable, terminators and addresses (MOVITRAC
// 31 PROFIBUS, 2.1.2, 2.5, 2.6, appendix A), and the time of a cycle.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/timing.hpp"

namespace ipos::profibus {

struct Cable {
  double ohms = 150;  // surge impedance, 3..20 MHz
  double picofarads_a_metre = 28;
  double ohms_a_kilometre = 105;  // of the loop
  double diameter = 0.65;         // of the core, mm
  double section = 0.35;          // mm2
  double metres = 100;
};

enum class InverterSeries : uint8_t { B, C };

// Option pcb FFP 31A or FFP 31C, or the interface that size 0 has built in. Card: of another unit, `card` says which.
enum class Interface : uint8_t { Ffp31A, Ffp31C, Size0, Card };

struct PlannedStation {
  std::string name;
  uint8_t address = 0;
  bool terminated = false;
  Interface interface = Interface::Ffp31C;
  InverterSeries series = InverterSeries::C;
  uint8_t size = 1;
  uint8_t service_code_4 = 14;  // of component 4; matters on 31B
  uint16_t ident = 0x3100;      // as the master's configuration has it
  uint8_t octets = 6;           // in each direction
  bool of_fms = false;          // a master of FMS asks it: it needs no configuration
  std::optional<Time> watchdog;
  const OptionType* card = nullptr;
};

struct LinePlan {
  uint32_t baud = 500'000;
  Cable cable;
  std::vector<uint8_t> masters{1};
  bool master_terminated = true;         // the first stands at the begin of the line
  std::vector<PlannedStation> stations;  // in the order of the cable
  Bits tsdr = 30;
  Bits idle_1 = 37;
  Bits idle_2 = 150;
  bool gap_poll = true;  // one a cycle
};

// The closed form of docs/reference/protocols/profibus.md.
Bits cycle_bits(const LinePlan& plan);

// In words; empty when all is well.
std::vector<std::string> check_plan(const LinePlan& plan);

// Of these those of cable, terminators, number of stations and addresses: what a master does not find out by itself.
std::vector<std::string> check_line(const LinePlan& plan);

// Terminators that are not where they must be, and missing ones.
size_t wrong_terminators(const LinePlan& plan);

}  // namespace ipos::profibus
