// A master of CANopen among the controls of a plant: what it meets at its nodes goes into the journal.
#pragma once

#include <string>
#include <utility>

#include "runtime/bus/canopen/master.hpp"
#include "runtime/journal/journal.hpp"

namespace ipos::runtime {

class CanopenControl final : private canopen::MasterObserver {
 public:
  // Name and journal must outlive it.
  CanopenControl(EventQueue& queue, uint32_t source, const std::string& name,
                 const canopen::MasterSettings& settings, Journal& journal)
      : name_(name), journal_(journal), master_(queue, source, settings, this) {}

  canopen::Master& master() { return master_; }
  const canopen::Master& master() const { return master_; }

 private:
  void on_node(Time now, bool wrong, std::string text) override {
    journal_.note(now, wrong ? Weight::Warning : Weight::Why, name_, std::move(text));
  }

  const std::string& name_;
  Journal& journal_;
  canopen::Master master_;
};

}  // namespace ipos::runtime
