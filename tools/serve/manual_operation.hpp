// Manual operation of a real drive (MDX60B/61B 4.4.3): it moves while somebody holds a button, and not longer. The line
// becomes the source of control and setpoint, the drive's own monitoring of process data is on as long, and both are
// given back after a stop that the drive has answered.
//
// What a hand does is noted at once, also between two questions to the drive; turn() lets the drive follow. It is called
// before every single question, so no order of anybody keeps a stop waiting.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/links/bus_link.hpp"
#include "tools/parameters/own_monitoring.hpp"
#include "tools/serve/borrowed_values.hpp"
#include "tools/serve/host/message.hpp"

namespace ipos::tools::serve {

// Ours.
inline constexpr auto kJogHolds = std::chrono::milliseconds(300);  // without a `jog` it stops

class ManualOperation {
 public:
  // `changed`: what state() says is another.
  ManualOperation(BusLink& link, ParameterAccess& access, uint8_t address, std::function<void()> changed);

  // A hand holds the button, or still does. A Mistake says why the drive does not move.
  void hold(uint16_t client, double rpm, WallClock::time_point arrived);
  // A `stop`, of any client.
  void stop(uint16_t client);
  // The client has gone, or may not write any more; all have.
  void let_go(uint16_t client);
  void let_go() { hand_.reset(); }

  void turn();
  // Until the drive has answered the stop and has its values back, but no longer than so.
  void finish(WallClock::duration patience);
  // What was left behind may be given back now.
  void may_write();

  // No hand, and no stop that is not answered.
  bool stands() const { return state_ == State::Idle || state_ == State::GivingBack; }
  // Not answered yet: for a person, in red. Empty: all is well.
  std::string alarm() const;
  // What is still borrowed, and why.
  std::vector<std::string> left() const;
  bool moves() const { return state_ == State::Moving; }

 private:
  enum class State : uint8_t { Idle, Taking, Moving, Stopping, GivingBack };
  struct Hand {
    uint16_t client;
    uint16_t speed;  // the setpoint word
    WallClock::time_point arrived;
  };
  struct Stopped {  // by another client; the one that holds must let go first
    uint16_t client;
    WallClock::time_point last;
  };

  void enter(State state);
  void take_control();
  void watch_over();  // the drive's own monitoring
  void expect(const char* number, const char* text);
  void use_this_line(const char* number);
  bool send(uint16_t control, uint16_t speed);
  void move(WallClock::time_point now);
  void stop_drive();
  void give_back(WallClock::time_point now);

  BusLink& link_;
  ParameterAccess& access_;
  uint8_t address_;
  std::function<void()> changed_;
  BorrowedValues borrowed_;
  bool serial_;
  State state_ = State::Idle;
  bool asks_ = false;  // turn() is under way
  std::optional<Hand> hand_;
  std::optional<Stopped> stopped_;
  // A client after whose jog the words go on, where the drive's monitoring was on before: it would tell a fault.
  std::optional<uint16_t> rests_for_;
  WallClock::duration period_{};         // of the words
  WallClock::time_point waits_until_{};  // for the first word of a hand, after what taking over has taken
  WallClock::time_point next_words_{};
  WallClock::time_point next_try_{};  // to give a value back
  WallClock::time_point heard_{};     // the last answer to process data
  int answered_ = 0;                  // stops in a row
  bool unanswered_ = false;           // one was not
};

}  // namespace ipos::tools::serve
