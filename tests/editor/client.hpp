// An editor in the test's own process: texts by path, requests with their answers, diagnostics as published.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/lsp/server.hpp"

namespace ipos::tests {

using tools::lsp::Json;

class Client {
 public:
  explicit Client(std::map<std::string, std::string> disk = {}, const Json& options = nullptr)
      : disk_(std::move(disk)),
        server_(
            [this](const std::string& path) -> std::optional<std::string> {
              const auto found = disk_.find(path);
              return found == disk_.end() ? std::nullopt : std::optional(found->second);
            },
            [this](const Json& message) { take(message); }) {
    request("initialize", {{"initializationOptions", options}});
    notify("initialized", Json::object());
  }

  // The whole answer: with result or error.
  Json ask(const std::string& method, const Json& params) {
    const int id = ++last_id_;
    server_.receive(Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump());
    settle();
    return answers_.contains(id) ? answers_[id] : Json();
  }
  Json request(const std::string& method, const Json& params) {
    return ask(method, params).value("result", Json());
  }
  // Code of the error; 0: there was none.
  int refused(const std::string& method, const Json& params) {
    const Json answer = ask(method, params);
    return answer.contains("error") ? answer["error"]["code"].get<int>() : 0;
  }
  void notify(const std::string& method, const Json& params) {
    server_.receive(Json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}}.dump());
    settle();
  }
  void open(const std::string& path, const std::string& text) {
    notify("textDocument/didOpen", {{"textDocument", {{"uri", "file://" + path}, {"text", text}}}});
  }

  static Json document(const std::string& path) { return {{"textDocument", {{"uri", "file://" + path}}}}; }
  static Json at(const std::string& path, int line, int character) {
    Json params = document(path);
    params["position"] = {{"line", line}, {"character", character}};
    return params;
  }
  // Codes of the messages shown for a file.
  std::vector<std::string> codes(const std::string& path) {
    std::vector<std::string> out;
    for (const Json& one : diagnostics["file://" + path]) out.push_back(one["code"]);
    return out;
  }

  void settle() {
    while (server_.run()) {
    }
  }
  tools::lsp::Server& server() { return server_; }

  std::map<std::string, Json> diagnostics;  // by URI
  std::vector<Json> strays;                 // answers without an id

 private:
  void take(const Json& message) {
    if (message.contains("method"))
      diagnostics[message["params"]["uri"]] = message["params"]["diagnostics"];
    else if (message["id"].is_number())
      answers_[message["id"]] = message;
    else
      strays.push_back(message);
  }

  std::map<std::string, std::string> disk_;
  std::map<int, Json> answers_;
  int last_id_ = 0;
  tools::lsp::Server server_;
};

}  // namespace ipos::tests
