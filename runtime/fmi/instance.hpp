// One instance of an FMU, as both versions of FMI see it: its state, its values, its time. The functions of FMI are thin layers
// over this (fmi2.cpp, fmi3.cpp). What is refused has changed nothing; only a plant that broke answers nothing any more.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/fmi/bus_terminal.hpp"
#include "runtime/fmi/package.hpp"
#include "runtime/library/session.hpp"

namespace ipos::fmi {

// As both versions number them.
enum class Status : uint8_t { Ok, Warning, Discard, Error, Fatal };

enum class Call : uint8_t {
#define FMI_CALL(call, fmi2, fmi3, states) call,
#include "runtime/fmi/calls.def"
};

// Where texts go: to the logger of the importer. category: of kCategories.
using Log = std::function<void(Status, const char* category, const std::string& text)>;
inline constexpr const char* kErrors = "logStatusError";
inline constexpr const char* kWarnings = "logStatusWarning";
inline constexpr const char* kJournal = "journal";

struct Step {
  double reached = 0;   // the time
  bool early = false;   // a fault has come before the end
  bool sends = false;   // a terminal has something to be fetched
};

// A state as it is kept: the record of the plant, and what stands around it.
struct SavedInstance;

class Instance {
 public:
  // Null: `log` has the reason. `version` is 2 or 3.
  static std::unique_ptr<Instance> make(int version, const std::string& token, const std::string& folder, Log log);
  ~Instance();

  // False: the call is not allowed now, and the log says so.
  bool allows(Call call);
  // Logs and gives it back.
  Status fail(Status status, std::string_view category, const std::string& text);
  Status fail(const std::string& text) { return fail(Status::Error, kErrors, text); }
  void set_logging(bool on) { logging_ = on; }

  Status set_start(double start);
  Status enter_initialization();
  Status exit_initialization(bool with_events);
  Status enter_events();
  Status enter_steps();
  Status terminate();
  Status reset();

  double time() const { return time_; }
  // `returns_early`: at the tick in which a fault appears.
  Status step(double from, double length, bool returns_early, Step& done);

  // Values by their references, all of which must be of one of these types.
  using Types = std::initializer_list<Type>;
  template <typename Value>
  Status get(std::span<const uint32_t> references, Types types, Value* values);
  Status set(std::span<const uint32_t> references, Types types, const std::function<double(size_t n)>& value);

  // Variables of terminals: their references follow those of the others, kTerminalMembers a terminal.
  struct Member {
    BusTerminal* terminal;
    TerminalMember kind;
    bool is_of_the_line() const { return terminal->is_of_the_line(); }
  };
  std::optional<Member> member(uint32_t reference) const;
  // Of a countdown, as FMI numbers what is known of it.
  struct Interval {
    enum class Known : uint8_t { NotYet, Unchanged, Changed };
    Known known = Known::NotYet;
    runtime::Time length = 0;  // from now on
  };
  Interval interval(BusTerminal& terminal);
  // The operations that have come act, and what was fetched is forgotten.
  Status update();

  std::unique_ptr<SavedInstance> save() const;
  Status restore(const SavedInstance& saved);
  std::string to_bytes(const SavedInstance& saved) const;
  // Null with a text in the log.
  std::unique_ptr<SavedInstance> from_bytes(std::string_view bytes);

 private:
  enum class Stage : uint8_t { Instantiated, Initialization, Steps, Events, Terminated };

  Instance(int version, std::string token, Package package, library::Contents contents, Log log);
  std::optional<std::string> open();
  std::optional<std::string> find_variables();
  Status check(std::span<const uint32_t> references, Types types);
  double value_of(uint32_t reference) const;
  BusTerminal* notified_terminal(uint32_t reference) const;
  Status set_notified(BusTerminal& terminal, bool on);
  Status set(const Variable& variable, double value);
  runtime::Time plant_time(double time) const;
  bool is_line() const { return package_.choice.line.has_value(); }
  void run(runtime::Time until, bool returns_early, Step& done);
  std::vector<uint8_t> faults() const;
  void tell_journal();

  int version_;
  std::string token_;
  Package package_;
  library::Contents contents_;
  Log log_;
  bool logging_ = false;
  Stage stage_ = Stage::Instantiated;
  double start_ = 0, time_ = 0;
  std::unique_ptr<library::Session> session_;
  Variables variables_;
  Terminals terminals_;  // none in FMI 2.0
  size_t told_ = 0;  // entries of the journal
};

template <typename Value>
Status Instance::get(std::span<const uint32_t> references, Types types, Value* values) {
  if (const Status wrong = check(references, types); wrong != Status::Ok) return wrong;
  for (size_t n = 0; n < references.size(); ++n) values[n] = static_cast<Value>(value_of(references[n]));
  return Status::Ok;
}

struct SavedInstance {
  static constexpr uint64_t kAlive = 0x69706F73464D5531;
  uint64_t mark = kAlive;  // a pointer that is none of ours is told before it does harm
  uint8_t stage = 0;
  double start = 0, time = 0;
  std::vector<uint8_t> plant;
  std::vector<TerminalBuffers> terminals;
};

}  // namespace ipos::fmi
