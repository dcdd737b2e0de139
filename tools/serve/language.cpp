// Each question brings the texts that it is about, so nothing has to be remembered when time goes back or a client goes;
// what is kept saves work only.
#include "tools/serve/language.hpp"

#include "tools/cli/files.hpp"

namespace ipos::tools::serve {
namespace {

constexpr std::string_view kDiagnostics = "diagnostics";

Json document(const std::string& uri) { return {{"uri", uri}}; }

}  // namespace

LanguageServer::LanguageServer(const CompileFlags& compile, lsp::ReadSurvivors survivors)
    : server_(try_read_file, [this](const Json& message) {
        if (message.value("method", "") == "textDocument/publishDiagnostics")
          diagnostics_[message["params"]["uri"].get<std::string>()] = message["params"]["diagnostics"];
        else
          reply_ = message;
      }) {
  server_.show_survivors(std::move(survivors));
  Json options{{"includeDirs", compile.include_dirs}, {"defines", compile.defines}, {"atomic", compile.atomic}};
  if (!compile.unit.empty()) options["unit"] = compile.unit;
  Json warnings = Json::array();
  for (const std::string& warning : compile.warnings) warnings.push_back(warning);
  options["warnings"] = std::move(warnings);
  options_ = std::move(options);
  say("initialize", {{"initializationOptions", options_}}, true);
}

Json LanguageServer::say(const char* method, Json params, bool wants_reply) {
  Json message{{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}};
  if (wants_reply) message["id"] = ++asked_;
  reply_ = nullptr;
  server_.receive(message.dump(-1, ' ', false, Json::error_handler_t::replace));
  while (server_.run()) {
  }
  if (reply_.is_object() && reply_.contains("error"))
    throw Mistake(reply_["error"].value("message", "the language server has no answer"));
  return reply_.is_object() && reply_.contains("result") ? reply_["result"] : Json();
}

void LanguageServer::show(const Texts& texts) {
  for (const auto& [uri, text] : Texts(shown_))
    if (!texts.contains(uri)) {
      say("textDocument/didClose", {{"textDocument", document(uri)}}, false);
      shown_.erase(uri);
      diagnostics_.erase(uri);
    }
  for (const auto& [uri, text] : texts) {
    const auto known = shown_.find(uri);
    if (known != shown_.end() && known->second == text) continue;
    Json opened = document(uri);
    opened["text"] = text;
    opened["version"] = 0;
    say("textDocument/didOpen", {{"textDocument", std::move(opened)}}, false);
    shown_[uri] = text;
  }
}

Json LanguageServer::answer(const std::string& method, const Json& params, const Texts& texts) {
  show(texts);
  if (method == kDiagnostics) {
    // Files that are not open may have changed: everything is compiled again.
    say("workspace/didChangeConfiguration", {{"settings", {{"ipos", options_}}}}, false);
    return diagnostics_;
  }
  return say(method.c_str(), params, true);
}

}  // namespace ipos::tools::serve
