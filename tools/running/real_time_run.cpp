// The plant as the real-time loop sees it, and the messages of a real-time run.
#include "tools/running/real_time_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "runtime/plant_file/outer_port.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/terminal.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

double ms(Time time) { return static_cast<double>(time) / 1e6; }

void message(const std::string& text) {
  static const bool has_progress_line = is_terminal(STDERR_FILENO);
  fmt::print(stderr, "{}ipos: {}\n", has_progress_line ? "\r\033[K" : "", text);
}

class PlantSimulation final : public runtime::Simulation {
 public:
  PlantSimulation(runtime::Plant& plant, const std::function<bool(Time)>& keep_going,
                  std::function<void()> after_each)
      : plant_(plant), keep_going_(keep_going), after_each_(std::move(after_each)) {}
  Time now() const override { return plant_.now(); }
  Time next_time() const override { return plant_.next_time(); }
  bool run_until(Time end) override {
    const bool goes_on = plant_.run_until(end, keep_going_);
    after_each_();
    return goes_on;
  }

 private:
  runtime::Plant& plant_;
  const std::function<bool(Time)>& keep_going_;
  std::function<void()> after_each_;
};

}  // namespace

void refuse_ports(const runtime::PlantFile& plant, const std::string& file) {
  bool refused = false;
  for (const runtime::BusConfig& bus : plant.buses) {
    if (!runtime::has_outer_port(bus)) continue;
    refused = true;
    fmt::print(
        stderr,
        "{}:{}:{}: error: bus '{}' is joined to port '{}': run it with --realtime, as the world outside "
        "does not wait for virtual time\n",
        file, bus.port_place.line, bus.port_place.column, bus.name, bus.port);
  }
  if (refused) throw Failure(kUsage, "");
}

RealTimeRun::RealTimeRun(runtime::Plant& plant, const std::string& file) : plant_(plant) {
  // Time is there anyway, and the loop waits from tick to tick.
  for (const auto& station : plant.stations()) station->use_pace(runtime::Pace::InTurn);
  bool failed = false;
  for (const runtime::BusConfig& bus : plant.file().buses) {
    if (!runtime::has_outer_port(bus)) continue;
    auto joined = join_port(plant_, *plant_.find_bus(bus.name), bus.port, clock_);
    if (!joined) {
      failed = true;
      fmt::print(stderr, "{}:{}:{}: error: {}\n", file, bus.port_place.line, bus.port_place.column,
                 joined.error().text);
      continue;
    }
    joined_.push_back(std::move(*joined));
    message(fmt::format("bus '{}' is joined to {}", bus.name, bus.port));
  }
  if (failed) throw Failure(kIoError, "");
}

bool RealTimeRun::run(Time limit, const std::function<bool(Time)>& keep_going) {
  const runtime::RealTimeLoop* running = nullptr;
  PlantSimulation simulation(plant_, keep_going, [&] { tell_news(*running); });
  runtime::RealTimeLoop loop(clock_, simulation);
  running = &loop;
  for (const runtime::JoinedPort& joined : joined_) loop.add(*joined.bridge);
  const runtime::RealTimeLoop::End end = loop.run(limit);
  tell_news(loop);
  report(loop.punctuality());
  return end != runtime::RealTimeLoop::End::PortGone;
}

void RealTimeRun::tell_news(const runtime::RealTimeLoop& loop) {
  for (const runtime::JoinedPort& joined : joined_)
    for (const std::string& text : joined.bridge->take_notes()) message("warning: " + text);
  const runtime::Punctuality& punctuality = loop.punctuality();
  if (!told_left_out_ && punctuality.left_out != 0) {
    told_left_out_ = true;
    message(fmt::format("warning: real time: this process stood still for {:.0f} ms; they are left out, for what is later than "
                        "{} ms is not made up for",
                        ms(punctuality.left_out), runtime::kForgiven / runtime::kMillisecond));
  }
  if (told_late_ || punctuality.first_late < 0) return;
  told_late_ = true;
  message(fmt::format("warning: real time: the tick of {:.3f} ms came {:.1f} ms late; later ones are counted",
                      ms(punctuality.first_late), ms(punctuality.worst)));
}

void RealTimeRun::report(const runtime::Punctuality& punctuality) const {
  message(fmt::format(
      "real time: {:.3f} s; {} ticks more than {} ms late, the worst {:.2f} ms; {:.2f} ms behind at the "
      "end{}",
      ms(plant_.now()) / 1e3, punctuality.late_ticks, runtime::kLateTick / runtime::kMillisecond,
      ms(punctuality.worst), ms(punctuality.lag),
      punctuality.left_out == 0 ? "" : fmt::format("; {:.3f} s left out", ms(punctuality.left_out) / 1e3)));
  for (const runtime::JoinedPort& joined : joined_) {
    const runtime::PortCounts& counts = joined.port->counts();
    const runtime::BridgeCounts& bridge = joined.bridge->counts();
    std::string text = fmt::format("{}: {} {} sent, {} received", joined.port->name(), counts.sent,
                                   joined.bridge->goods(), counts.received);
    const auto add = [&text](uint64_t count, std::string_view what) {
      if (count != 0) text += fmt::format(", {} {}", count, what);
    };
    add(counts.lost_out, "lost on the way out");
    add(counts.lost_in, "lost on the way in");
    add(counts.waited, "times no room to send");
    add(joined.port->waiting(), "not sent any more");
    add(bridge.undelivered, "not taken by any station");
    add(joined.bridge->waiting(), "not on the line yet");
    add(bridge.late, "late");
    if (bridge.late != 0) text += fmt::format(" (up to {:.2f} ms)", ms(bridge.worst_late));
    message(text);
    for (const std::string& repeat : joined.bridge->repeats()) message(repeat);
  }
}

}  // namespace ipos::tools
