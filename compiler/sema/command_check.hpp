// Warnings of commands that the machine refuses, ignores or carries out otherwise than the program looks: what MOVLNK, SCOM
// and VARINT find in their structures, where their data lie, and which commands wait, are lacking or come too late. Each
// message holds on a way through the program that ConstantFlow has followed.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/sema/constant_flow.hpp"

namespace ipos::compiler {

// Members of MOVLNK (1053 1610 p. 47).
struct MovlnkMember {
  enum : uint32_t { BusType, Address, Format, Service, Index, DPointer, Result };
};
// WritePar ReadPar PO1 PO2 PO3 PI1 PI2 PI3 (1053 1610 p. 47).
struct MldataMember {
  enum : uint32_t { ReadPar = 1, Input = 5, Size = 8 };
};
// What a Format of MOVLNK carries: 0..6, and 128 more for acyclic ones. Nothing: there is no such format.
struct LinkFormat {
  bool parameter;
  uint32_t words;  // process data
};
std::optional<LinkFormat> link_format(int32_t code);

inline constexpr int32_t kOwnUnitAddress = 253;  // MOVLNK to it does not wait

// What the checks of the commands share.
class CommandCheck {
 public:
  CommandCheck(Context& context, const ProgramRoots& roots, const ConstantFlow& flow)
      : context_(context), roots_(roots), flow_(flow) {}

  void operator()(const ConstantFlow::Point& point);
  void operator()(const ConstantFlow::Unfed& unfed);

  // MOVLNK commands that write into the non-volatile memory of a unit.
  const std::set<const checked::Expr*>& kept() const { return kept_; }
  // What is known of a MOVLNK command.
  struct Exchange {
    bool own_unit = false;           // no line can fail
    bool writes = false;             // a parameter
    std::optional<uint32_t> data{};  // first variable
  };
  const std::map<const checked::Expr*, Exchange>& exchanges() const { return exchanges_; }
  // SBus objects that are sent cyclically or received, by the command that sets them up: their number, where it is known.
  struct Object {
    std::optional<int32_t> number{};
    bool receive = false;
  };
  const std::map<const checked::Expr*, Object>& objects() const { return objects_; }

 private:
  using Point = ConstantFlow::Point;

  // sbus_command.cpp
  void check_object(const Point& point);
  void check_offset(uint32_t first);
  void check_twice(const Point& point, uint32_t first, bool receive);
  void check_object_data(const Point& point, uint32_t first, bool receive, int32_t bytes, const KnownValue& pointer);

  // movilink_command.cpp
  void check_movilink(const Point& point);
  void check_bus(const Point& point, uint32_t first);
  void check_parameter(const Point& point, uint32_t first);
  void check_movilink_data(const Point& point, int32_t format, const KnownValue& pointer);

  // waiting_command.cpp
  void check_interrupt(const Point& point);
  void check_mask(const Point& point, uint32_t first);
  void check_source(const Point& point, uint32_t first);
  void check_number(const Point& point, uint32_t first);
  void check_waiting(const Point& point);
  void check_lacking(const Point& point);

  // Variables that a command uses from one of them on: declared ones behind it that it reaches, too.
  struct Reach {
    const Variable* first = nullptr;   // in which the data begin
    uint32_t own = 0;                  // variables from there to its end
    const Variable* beyond = nullptr;  // the next that is reached
    uint32_t number = 0;               // of `beyond`, where it is reached
  };
  Reach reach(int32_t number, uint32_t count) const;
  // Variables in a row, each a `long`, may be meant as a block; one that the program writes while it leaves the first one to
  // the unit is not meant.
  bool is_neighbour(const Reach& reach) const;
  bool is_written(uint32_t number) const;
  // A variable of the program that nobody writes: only telegrams and interrupts have its number, and they read it.
  bool stays_zero(int32_t number) const;
  void check_copy(const Point& point);

  // Values of a member that the program assigns.
  template <typename Refused>
  void refuse(Diag diag, uint32_t number, Refused refused) {
    for (const KnownValue& known : flow_.values(number))
      if (known.assigned())
        if (std::string reason = refused(known.value); !reason.empty()) warn(diag, known.span, {std::move(reason)});
  }
  const Variable* variable_of(uint32_t number) const;
  std::string name_of(uint32_t number) const;  // of the variable, or H5
  Span place(const KnownValue& known, const Point& point) const { return known.assigned() ? known.span : point.expr.span; }
  bool beyond_unit(const Point& point, const KnownValue& pointer, uint32_t count);
  Diagnostic* warn(Diag diag, Span span, std::vector<std::string> args);

  Context& context_;
  const ProgramRoots& roots_;
  const ConstantFlow& flow_;
  std::set<std::pair<Diag, uint32_t>> reported_;
  std::set<const checked::Expr*> kept_;
  std::map<const checked::Expr*, Exchange> exchanges_;
  std::map<const checked::Expr*, Object> objects_;
  std::optional<uint32_t> first_of_number_0_;  // structure of a variable interrupt
  std::set<uint32_t> short_watchdogs_;  // where they are started
};

// The whole of it, and what needs no values: objects that nothing starts, timers, memory (program_check.cpp).
void check_commands(Context& context, const ProgramRoots& roots);

}  // namespace ipos::compiler
