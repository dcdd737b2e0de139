// The language server: messages in, messages out. Knows nothing of streams, so tests talk to it directly.
#pragma once

#include <deque>
#include <functional>
#include <set>

#include "tools/lsp/plant_objects.hpp"
#include "tools/lsp/workspace.hpp"
#include "tools/survivors/survivors.hpp"

namespace ipos::tools::lsp {

// Mistakes that no test of a source with this text has noticed.
using ReadSurvivors = std::function<std::vector<Survivor>(const std::string& path, std::string_view text)>;

class Server {
 public:
  // `send` takes the body of a message to the editor.
  Server(ReadFile read_file, std::function<void(const Json&)> send)
      : workspace_(std::move(read_file)), send_(std::move(send)) {}

  // Shows them among the messages of sources.
  void show_survivors(ReadSurvivors read) { read_survivors_ = std::move(read); }

  // Takes a message; it is answered by run(). A cancellation takes effect on what waits.
  void receive(std::string_view body);
  // Answers the next message that waits; when none does, tells what changes mean for the diagnostics. False
  // when there was nothing to do.
  bool run();
  bool waiting() const { return !queue_.empty(); }
  // To be called now and then while the editor says nothing: tests may have been tried again.
  void look_at_survivors();

  bool ended() const { return ended_; }
  // After exit: 0 when shutdown came before it, as the protocol wants.
  int exit_code() const { return shut_down_ ? 0 : 1; }

 private:
  void handle(const Json& message);
  void request(const Json& id, const std::string& method, const Json& params);
  void notification(const std::string& method, const Json& params);
  Json initialize(const Json& params);
  void document(const std::string& method, const Json& params);
  void respond(const Json& id, Json result);
  void respell(Json& value) const;
  void refuse(const Json& id, ErrorCode code, const std::string& message);
  void publish();
  std::vector<Survivor> survivors_of(const std::string& path) const;

  Workspace workspace_;
  std::function<void(const Json&)> send_;
  ReadSurvivors read_survivors_;
  std::map<std::string, std::vector<Survivor>> survivors_;  // shown, by path
  PlantObjects objects_;
  std::deque<Json> queue_;
  std::map<std::string, std::string> spellings_;  // of open documents: ours, and that of the editor where it differs
  std::set<std::string> published_;  // paths with messages shown
  bool outdated_ = false;            // texts changed since publish()
  bool initialized_ = false;
  bool shut_down_ = false;
  bool ended_ = false;
};

}  // namespace ipos::tools::lsp
