// The script of a test: its items one after the other, in the virtual time of a plant that somebody else runs. `ipos test`
// runs it to where the script wants to go on; the debugger runs it as its user wants and tells what has passed.
//
// A step at T is planned when everything of the millisecond before has happened, so that it acts at the beginning of
// T; an expectation at T looks when everything of T has happened. A step after it then acts in the next millisecond. In a
// test by hand a step at T acts when everything of T has happened.
#pragma once

#include <list>
#include <map>

#include "tools/testing/actor.hpp"
#include "tools/testing/check.hpp"
#include "tools/testing/probe.hpp"
#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

// How long a program may run that is expected to end.
inline constexpr Time kProgramLimit = 60 * runtime::kSecond;

class Script {
 public:
  // Before the first event of the plant; all three must outlive it. Findings and checks are added to the result.
  Script(const TestCase& test, runtime::Plant& plant, uint64_t seed, TestResult& result);

  // Finds what the items name; errors are of the test file.
  std::vector<runtime::PlantError> resolve();

  // Once, before the first event. Then, until it is over: passed() after every millisecond, and go_on() when due() has
  // come or passed() was false.
  void begin();
  bool over() const { return stage_ == Stage::Over; }
  // So far the plant has to be run, this time included.
  Time due() const { return due_; }
  // Everything of this time has happened. False: the script wants to go on from here.
  bool passed(Time now);
  void go_on();

  // What follows makes no sense any more: it takes too long, or is interrupted; or something of the plant file has failed,
  // which stands there.
  void give_up(std::string text, std::optional<FilePlace> in_plant = {});

 private:
  enum class Stage : uint8_t {
    Next,   // item
    Plan,   // a step
    Look,   // at a value
    Wait,   // for an expectation or a frame
    AtEnd,  // all programs have to end
    Rest,   // nothing is done any more, but something is watched
    Over
  };
  struct Open {
    const Item* item;
    Check check;
    const Reader* read;  // null for events
  };
  struct Later {  // a value that was wrong at its time
    size_t finding;
    const Expect* expect;
    const Reader* read;
    Time wanted;
  };

  bool further();
  bool next_item();
  void take(const Item& item);
  void perform(const Item& item);
  void look_now(const Item& item, const Expect& expect);
  Open& watch(const Item& item, const Expect& expect, Time start);
  void wait_for(const Item& item, const Expect& expect);
  bool still_waits();
  Check::Verdict watched(const Item& item) const;
  void tell_event(const std::string& bus, Time now, const std::string& text, const std::string& meaning);
  void settle();
  Time last_time() const;
  void finish();
  void find_faults();
  void stop(const Item& item, std::string text);
  void add_finding(const Item* item, std::string text);
  std::vector<std::string> source_of(FilePlace place) const;

  const TestCase& test_;
  runtime::Plant& plant_;
  TestResult& result_;
  Probe probe_;
  Actor actor_;
  std::map<const Item*, Reader> readers_;
  std::list<Open> open_;
  std::vector<Later> later_;
  Stage stage_ = Stage::Next;
  size_t next_ = 0;             // item
  const Item* item_ = nullptr;  // of the stage
  Time due_ = -1;
  Time cursor_ = 0;  // of the script
  Time done_ = -1;   // up to here, this time included, everything has happened
  const Item* waiting_ = nullptr;
  bool stopped_ = false;
};

}  // namespace ipos::tools::testing
