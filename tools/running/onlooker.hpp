// What lets others look at a run while it goes on. Which one there is a program says once, before its verbs: the room of the
// debugger has one, and a program without that room has none.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

class Onlooker {
 public:
  virtual ~Onlooker() = default;
  // Between two milliseconds of the plant, often: takes what was asked and answers, and never waits.
  virtual void look() = 0;
};

// Of a plant that was read from `file`; null where nobody can come.
using MakeOnlooker = std::function<std::unique_ptr<Onlooker>(runtime::Plant& plant, const std::string& file)>;

void use_onlookers(MakeOnlooker make);
std::unique_ptr<Onlooker> onlooker_of(runtime::Plant& plant, const std::string& file);

}  // namespace ipos::tools
