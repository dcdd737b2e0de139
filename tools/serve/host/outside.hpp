// What a host asks of the world around it beside messages and the time: real ports of the plant, the files that belong to
// it, and what a language server says of their texts. As they stand here there is nothing of it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/cli/told.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/message.hpp"
#include "tools/sessions/session.hpp"

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

// By the name of a file.
using sessions::Texts;

// The plant as its files are now: read, compiled and checked.
struct Build {
  bool good() const { return make.has_value(); }

  std::optional<debug::Debuggee> make;  // empty: it has mistakes
  std::vector<std::string> stations;               // their names
  std::vector<std::optional<vm::Image>> programs;  // by station
  Texts texts;                                     // that it was made of
  std::vector<Told> messages;
};

// The files that belong to the open plant, by the names that the compiler and the readers know them by. As it stands here
// there are none.
class Files {
 public:
  enum class Kind : uint8_t { Plant, Program, Include, Test, Session };
  struct Entry {
    std::string name;
    Kind kind = Kind::Program;
    std::string uri{};        // as requests of the language server protocol have it
    std::string read_only{};  // why it cannot be written; empty: it can
  };

  virtual ~Files() = default;
  // The plant file, its programs and their local includes, its tests and sessions.
  virtual std::vector<Entry> list() { return {}; }
  // What was compiled at the start.
  virtual std::optional<std::string> compiled(const std::string& /*file*/) { return std::nullopt; }
  // What stands there now. Any file that was compiled can be read, and each of list().
  virtual std::optional<std::string> text(const std::string& /*file*/) { return std::nullopt; }
  // It is another one than this text by now.
  virtual bool has_changed(const std::string& file, const std::string& since) { return text(file) != since; }
  // Puts the text there, the old one or the new one at any moment: into one of list(), or into a new test or session beside
  // the plant. Returns the name that it has in list(). A Mistake says why not.
  virtual std::string write(const std::string& file, const std::string& /*text*/) {
    throw Mistake("no files belong to this plant; '" + file + "' cannot be written");
  }
  // Reads and compiles everything again. Nothing that runs is touched.
  virtual Build build() { throw Mistake("no files belong to this plant; it cannot be built"); }
  // Carries out these tests; the report as `ipos test --format json` prints it.
  virtual std::string test(const std::vector<std::string>& /*files*/) { throw Mistake("no tests can be run here"); }
  // Programs that a new station can begin with, by their names.
  virtual Texts templates() { return {}; }
  // The test whose script runs beside the plant; its file by the name of the list.
  virtual std::optional<sessions::OfTest> test_beside() { return std::nullopt; }
};

// What editors ask a language server: completion, hover, messages.
class Language {
 public:
  virtual ~Language() = default;
  // Answers a request of the language server protocol. `texts` are those of the editor where they are not those of the
  // files, by their URIs. `diagnostics` has no answer of its own in the protocol: it is the messages of all these texts.
  virtual Json answer(const std::string& /*method*/, const Json& /*params*/, const Texts& /*texts*/) { return nullptr; }
};

}  // namespace ipos::tools::serve
