// What a host asks of the world around it beside messages and the time: real ports of the plant, and the texts of its
// programs. As they stand here there is nothing: the plant is alone, and no text is known.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/message.hpp"

namespace ipos::tools::serve {

// What has come over real ports goes onto the lines between two milliseconds, and what the lines have carried goes out.
class Ports {
 public:
  // A port that has come or gone.
  struct Change {
    bool there;
    std::string text;  // for the journal; empty: it was told often enough
  };

  virtual ~Ports() = default;
  // Opens them before the first event; a Failure names one that cannot be had. `file`: of the plant.
  virtual void join(runtime::Plant& /*plant*/, const std::string& /*file*/) {}
  // Closes them. The plant must still be there.
  virtual void leave() {}
  virtual bool joined() const { return false; }
  virtual bool joined(const std::string& /*bus*/) const { return false; }
  // Sends on what the lines have carried.
  virtual void flush() {}
  // Takes what has come. The plant was at `at` when the clock was at `clock`.
  virtual void collect(WallClock::time_point /*clock*/, runtime::Time /*at*/) {}
  // What the ports had to say since the last time, and which of them have come or gone by now.
  virtual std::vector<std::string> take_notes() { return {}; }
  virtual std::vector<Change> take_changes(runtime::Time /*now*/) { return {}; }
  // Of each port: its line, its name, whether it is there, since when, and why not.
  virtual Json states() const { return Json::array(); }
};

// Sources of the programs, as they were when they were compiled.
class Sources {
 public:
  virtual ~Sources() = default;
  virtual std::optional<std::string> text(const std::string& /*file*/) { return std::nullopt; }
  // The file is another one by now.
  virtual bool has_changed(const std::string& /*file*/) { return false; }
};

}  // namespace ipos::tools::serve
