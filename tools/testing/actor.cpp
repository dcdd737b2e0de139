// Steps.
#include "tools/testing/actor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/signal_port.hpp"

namespace ipos::tools::testing {

using runtime::kMillisecond;

// A station without any manners: sends what it is told and acknowledges what it hears.
class Actor::Sender final : public runtime::CanNode, public runtime::SerialNode {
 public:
  void attach(runtime::CanLine& line) {
    can_ = &line;
    node_ = line.attach("test", line.baud(), *this);
  }
  void attach(runtime::Rs485Line& line) {
    serial_ = &line;
    node_ = line.attach("test", line.baud(), *this);
  }

  std::optional<std::string> send(const SendStep& step) {
    if (const auto* bytes = std::get_if<std::vector<uint8_t>>(&step.content))
      return serial_->send(node_, *bytes)
                 ? std::nullopt
                 : std::optional<std::string>("the telegram before is still being sent");
    const runtime::SendStatus status = can_->send(node_, std::get<runtime::Frame>(step.content), 0);
    if (status == runtime::SendStatus::Queued) return std::nullopt;
    return status == runtime::SendStatus::QueueFull ? "too many frames wait to be sent" : "the bus is off";
  }

  void on_frame(Time, const runtime::Frame&) override {}
  void on_sent(Time, const runtime::Frame&, uint64_t) override {}
  void on_not_sent(Time, const runtime::Frame&, uint64_t, runtime::NotSent) override {}
  void on_bus_off(Time) override { can_->recover(node_); }
  void on_character(Time, const runtime::Character&) override {}
  void on_sent(Time) override {}

 private:
  runtime::CanLine* can_ = nullptr;
  runtime::Rs485Line* serial_ = nullptr;
  runtime::NodeId node_ = runtime::kNoNode;
};

Actor::Actor(runtime::Plant& plant, const std::vector<Item>& items, uint64_t seed, Problem on_problem)
    : plant_(plant), seed_(seed), on_problem_(std::move(on_problem)) {
  for (const Item& item : items)
    if (const auto* step = std::get_if<Step>(&item.what))
      if (const auto* send = std::get_if<SendStep>(step)) attach(send->bus);
}

Actor::~Actor() = default;

void Actor::attach(const std::string& bus) {
  auto& sender = senders_[bus];
  if (sender) return;
  sender = std::make_unique<Sender>();
  for (const auto& line : plant_.lines())
    if (line->name() == bus) sender->attach(*line);
  for (const auto& line : plant_.serial_lines())
    if (line->line.name() == bus) sender->attach(line->line);
}

runtime::Station& Actor::station(const std::string& name) {
  return **std::find_if(plant_.stations().begin(), plant_.stations().end(),
                        [&](const auto& station) { return station->config().name == name; });
}

void Actor::plan(const Item& item, const Step& step, Time at) {
  // What holds longer than a moment is a stimulus of the plant.
  if (const auto* stimulus = std::get_if<runtime::Stimulus>(&step)) {
    std::string why;
    const auto port = runtime::SignalPort::find(plant_.stations(), stimulus->signal, why);
    if (!port) return on_problem_(item, why);
    if (stimulus->action != runtime::Stimulus::Action::Set || stimulus->every != 0) {
      runtime::Stimulus timed = *stimulus;
      timed.at = at;
      return plant_.surroundings().add(*port, timed);
    }
  }
  plant_.surroundings().act(at, [this, &item, &step, at] {
    std::optional<std::string> problem;
    if (const auto* stimulus = std::get_if<runtime::Stimulus>(&step)) problem = set(*stimulus);
    if (const auto* words = std::get_if<ProcessDataStep>(&step)) set_word(*words);
    if (const auto* send = std::get_if<SendStep>(&step)) problem = senders_[send->bus]->send(*send);
    if (const auto* fault = std::get_if<runtime::FaultConfig>(&step)) problem = plant_fault(*fault, at);
    if (const auto* fault = std::get_if<DriveFaultStep>(&step))
      station(fault->station).drive().state().raise_fault(fault->number);
    if (const auto* program = std::get_if<ProgramStep>(&step)) problem = control(*program);
    if (const auto* power = std::get_if<PowerStep>(&step))
      power->on ? station(power->station).power_on() : station(power->station).power_off();
    if (problem) on_problem_(item, *problem);
  });
}

std::optional<std::string> Actor::set(const runtime::Stimulus& stimulus) {
  std::string why;
  const auto port = runtime::SignalPort::find(plant_.stations(), stimulus.signal, why);
  if (!port->is_input()) return port->write(stimulus.value);
  if (port->line().driven)
    return fmt::format("{} of {} hangs on a wire or switch: force it, do not set it", stimulus.signal.name,
                       stimulus.signal.station);
  port->line().set = stimulus.value;
  return std::nullopt;
}

// Words come as over the bus that P101 names, or P100, or else the SBus.
void Actor::write_words(const std::string& name, const runtime::DriveWords& words) {
  runtime::DriveServer& drive = station(name).drive();
  const int32_t control = drive.value("101");
  const int32_t setpoint = drive.value("100");
  if (control == 1 || (control == 0 && setpoint == 2))
    drive.state().take_po(runtime::PoSource::Rs485, words);
  else if (control == 2 || (control == 0 && setpoint == 3))
    drive.state().take_po(runtime::PoSource::Fieldbus, words);
  else
    drive.take_output(plant_.now(), runtime::OutputChannel::Single, words);
}

// A forced word is written again every millisecond, like a telegram of a master that never rests.
void Actor::set_word(const ProcessDataStep& step) {
  auto& forced = forced_[step.station][step.word];
  const bool holds = forced.has_value();
  forced.reset();
  if (step.action == ProcessDataStep::Action::Release) return;
  if (step.action == ProcessDataStep::Action::Force) forced = step.value;
  runtime::DriveWords words = station(step.station).drive().state().po();
  words[step.word] = step.value;
  write_words(step.station, words);
  if (forced && !holds) plan_forced(step.station, step.word);
}

void Actor::plan_forced(const std::string& name, uint8_t word) {
  plant_.surroundings().act(plant_.now() + kMillisecond, [this, name, word] {
    const std::optional<uint16_t> value = forced_[name][word];
    if (!value) return;
    runtime::DriveWords words = station(name).drive().state().po();
    words[word] = *value;
    write_words(name, words);
    plan_forced(name, word);
  });
}

std::optional<std::string> Actor::control(const ProgramStep& step) {
  runtime::Station& station = this->station(step.station);
  if (step.action == ProgramStep::Action::Stop) {
    station.stop_program();
    return std::nullopt;
  }
  if (step.action == ProgramStep::Action::Start && !station.program_over()) return "the program runs already";
  return station.start_program();
}

std::optional<std::string> Actor::plant_fault(runtime::FaultConfig fault, Time at) {
  fault.fault.from += at;
  if (fault.fault.until != runtime::kNever) fault.fault.until += at;
  fault.fault.seed += seed_;
  if (plant_.plant_fault(fault)) return std::nullopt;
  return fmt::format("station '{}' is not on bus '{}'", fault.station, fault.bus);
}

}  // namespace ipos::tools::testing
