// Life cycle, dispatch by method, and publishing of diagnostics.
#include "tools/lsp/server.hpp"

#include <algorithm>
#include <span>

#include "tools/lsp/features.hpp"
#include "tools/lsp/marks.hpp"
#include "tools/lsp/plant_document.hpp"
#include "tools/lsp/plant_names.hpp"
#include "tools/lsp_base/transport.hpp"

namespace ipos::tools::lsp {
namespace {

struct Method {
  std::string_view name;
  Json (*answer)(Workspace&, const Json&);
};

constexpr Method kMethods[] = {
    {"textDocument/hover", hover},
    {"textDocument/completion", completion},
    {"textDocument/signatureHelp", signature_help},
    {"textDocument/definition", definition},
    {"textDocument/references", references},
    {"textDocument/documentHighlight", highlights},
    {"textDocument/prepareRename", prepare_rename},
    {"textDocument/rename", rename},
    {"textDocument/documentSymbol", document_symbols},
    {"textDocument/formatting", formatting},
    {"textDocument/foldingRange", folding_ranges},
    {"textDocument/inlayHint", inlay_hints},
    {"textDocument/semanticTokens/full", semantic_tokens},
    {"textDocument/codeLens", code_lenses},
    {"textDocument/codeAction", code_actions},
    {"workspace/symbol", workspace_symbols},
    {"ipos/header", header_text},
};

// The same for plants and tests.
constexpr Method kPlantMethods[] = {
    {"textDocument/hover", plant_hover},
    {"textDocument/completion", plant_completion},
    {"textDocument/definition", plant_definition},
    {"textDocument/documentSymbol", plant_symbols},
    {"textDocument/references", plant_references},
    {"textDocument/prepareRename", plant_prepare_rename},
    {"textDocument/rename", plant_rename},
    {"textDocument/foldingRange", plant_folding_ranges},
    {"textDocument/semanticTokens/full", plant_semantic_tokens},
    {"textDocument/codeLens", plant_code_lenses},
    {"textDocument/codeAction", plant_code_actions},
};

Json capabilities(Encoding encoding) {
  return {{"positionEncoding", encoding == Encoding::Utf8 ? "utf-8" : "utf-16"},
          {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
          {"hoverProvider", true},
          {"completionProvider", {{"triggerCharacters", {".", "#", "<", "\"", "["}}}},
          {"signatureHelpProvider", {{"triggerCharacters", {"(", ","}}}},
          {"definitionProvider", true},
          {"referencesProvider", true},
          {"documentHighlightProvider", true},
          {"documentSymbolProvider", true},
          {"workspaceSymbolProvider", true},
          {"documentFormattingProvider", true},
          {"foldingRangeProvider", true},
          {"inlayHintProvider", true},
          {"semanticTokensProvider",
           {{"legend", {{"tokenTypes", kTokenTypes}, {"tokenModifiers", kTokenModifiers}}}, {"full", true}}},
          {"codeLensProvider", Json::object()},
          {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
          {"renameProvider", {{"prepareProvider", true}}}};
}

std::string string_or(const Json& object, const char* name) {
  if (!object.is_object()) return {};
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Json member(const Json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? Json() : *found;
}

}  // namespace

void Server::receive(std::string_view body) {
  Json message = parsed(body);
  if (message.is_discarded()) {
    refuse(nullptr, ErrorCode::ParseError, "the message is no JSON");
    return;
  }
  if (string_or(message, "method") != "$/cancelRequest") {
    queue_.push_back(std::move(message));
    return;
  }
  const Json id = member(member(message, "params"), "id");
  const auto found = std::find_if(queue_.begin(), queue_.end(), [&](const Json& one) {
    return !id.is_null() && member(one, "id") == id && one.contains("method");
  });
  if (found == queue_.end()) return;  // answered already
  queue_.erase(found);
  refuse(id, ErrorCode::RequestCancelled, "cancelled");
}

bool Server::run() {
  if (!queue_.empty()) {
    const Json message = std::move(queue_.front());
    queue_.pop_front();
    handle(message);
    return true;
  }
  if (!outdated_) return false;
  outdated_ = false;
  publish();
  return true;
}

void Server::handle(const Json& message) {
  const std::string method = string_or(message, "method");
  const Json id = member(message, "id");
  if (method.empty()) {
    // An answer of the editor has an id and no method; this server asks nothing.
    if (!message.is_object() || !(message.contains("result") || message.contains("error")))
      refuse(id, ErrorCode::InvalidRequest, "the message has no method");
    return;
  }
  Json params = member(message, "params");
  if (!params.is_object()) params = Json::object();
  try {
    if (id.is_null())
      notification(method, params);
    else
      request(id, method, params);
  } catch (const RequestError& error) {
    if (!id.is_null()) refuse(id, error.code(), error.what());
  } catch (const Json::exception&) {  // whose text is about our code
    if (!id.is_null()) refuse(id, ErrorCode::InvalidParams, "the parameters are not as the protocol says");
  } catch (const std::exception&) {
    if (!id.is_null()) refuse(id, ErrorCode::InternalError, "the request failed");
  }
}

void Server::request(const Json& id, const std::string& method, const Json& params) {
  if (method == "initialize") {
    if (initialized_) throw RequestError(ErrorCode::InvalidRequest, "initialize came before");
    respond(id, initialize(params));
    return;
  }
  if (!initialized_) throw RequestError(ErrorCode::NotInitialized, "initialize has to come first");
  if (shut_down_) throw RequestError(ErrorCode::InvalidRequest, "shutdown came before");
  if (method == "shutdown") {
    shut_down_ = true;
    respond(id, nullptr);
    return;
  }
  const auto find = [&method](std::span<const Method> rows) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const Method& one) { return one.name == method; });
    return row == rows.end() ? nullptr : &*row;
  };
  const Method* of_programs = find(kMethods);
  if (of_programs == nullptr) throw RequestError(ErrorCode::MethodNotFound, "unknown method " + method);
  const bool plant =
      method.starts_with("textDocument/") && is_plant_document(workspace_, document_path(params));
  const Method* row = plant ? find(kPlantMethods) : of_programs;
  // Null: what programs have and plants have not.
  respond(id, row == nullptr ? Json(nullptr) : row->answer(workspace_, params));
}

Json Server::initialize(const Json& params) {
  std::vector<std::string> folders;
  for (const Json& folder : member(params, "workspaceFolders"))
    if (const std::string uri = string_or(folder, "uri"); !uri.empty()) folders.push_back(path_of(uri));
  if (const std::string root = string_or(params, "rootUri"); folders.empty() && !root.empty())
    folders.push_back(path_of(root));
  workspace_.set_folders(std::move(folders));
  workspace_.set_options(member(params, "initializationOptions"));
  const Json encodings = member(member(member(params, "capabilities"), "general"), "positionEncodings");
  if (encodings.is_array() && std::find(encodings.begin(), encodings.end(), "utf-8") != encodings.end())
    workspace_.encoding = Encoding::Utf8;
  initialized_ = true;
  return {{"capabilities", capabilities(workspace_.encoding)},
          {"serverInfo", {{"name", "ipos"}, {"version", IPOS_VERSION}}}};
}

void Server::notification(const std::string& method, const Json& params) {
  if (method == "exit") {
    ended_ = true;
  } else if (!initialized_ || shut_down_) {
    // Only exit counts then.
  } else if (method.starts_with("textDocument/did")) {
    document(method, params);
    outdated_ = true;
    if (method != "textDocument/didChange") objects_.outdate();
  } else if (method == "workspace/didChangeWatchedFiles") {
    for (const Json& change : member(params, "changes"))
      if (const std::string uri = string_or(change, "uri"); !uri.empty()) workspace_.touched(path_of(uri));
    outdated_ = true;
    objects_.outdate();
  } else if (method == "workspace/didChangeConfiguration") {
    const Json settings = member(member(params, "settings"), "ipos");
    if (settings.is_object()) workspace_.set_options(settings);
    outdated_ = true;
    objects_.outdate();
  }
}

void Server::document(const std::string& method, const Json& params) {
  const std::string path = document_path(params);
  const std::string asked = string_or(member(params, "textDocument"), "uri");
  if (asked == uri_of(path))
    spellings_.erase(asked);
  else
    spellings_[uri_of(path)] = asked;
  if (method == "textDocument/didOpen")
    workspace_.open(path, string_or(member(params, "textDocument"), "text"));
  else if (method == "textDocument/didChange")
    workspace_.change(path, member(params, "contentChanges"));
  else if (method == "textDocument/didClose")
    workspace_.close(path);
  else
    workspace_.touched(path);
}

// The messages of all programs that are open or that an open header belongs to. Files that had some and have
// none any more are told so.
void Server::publish() {
  std::map<std::string, Json> all;
  std::map<std::string, std::set<std::string>> told;  // of files that several programs have
  std::set<const Program*> programs;
  for (const std::string& path : workspace_.open_documents()) {
    if (is_plant_document(workspace_, path))
      all.emplace(path, plant_diagnostics(workspace_, path));
    else if (!path.ends_with(".toml"))
      programs.insert(&workspace_.program(path));
  }
  for (const Program* program : programs) {
    for (auto& [path, messages] : diagnostics_of(workspace_, *program)) {
      Json& target = all.try_emplace(path, Json::array()).first->second;
      for (Json& one : messages)
        if (programs.size() == 1 || told[path].insert(one.dump()).second) target.push_back(std::move(one));
    }
  }
  for (auto& [path, messages] : objects_.diagnostics(workspace_)) {
    Json& target = all.try_emplace(path, Json::array()).first->second;
    for (Json& one : messages) target.push_back(std::move(one));
  }
  survivors_.clear();
  for (auto& [path, messages] : all) {
    if (path.ends_with(".toml")) continue;
    std::vector<Survivor> survivors = survivors_of(path);
    for (Json& one : diagnostics_of(workspace_, path, survivors)) messages.push_back(std::move(one));
    survivors_.emplace(path, std::move(survivors));
  }
  for (const std::string& path : published_) all.try_emplace(path, Json::array());
  for (auto& [path, messages] : all) {
    const bool empty = messages.empty();
    if (empty && !published_.contains(path) && !workspace_.is_open(path)) continue;
    Json params{{"uri", uri_of(path)}, {"diagnostics", std::move(messages)}};
    respell(params);
    send_({{"jsonrpc", "2.0"}, {"method", "textDocument/publishDiagnostics"}, {"params", std::move(params)}});
    if (empty)
      published_.erase(path);
    else
      published_.insert(path);
  }
}

std::vector<Survivor> Server::survivors_of(const std::string& path) const {
  const auto text = read_survivors_ ? workspace_.text(path) : std::nullopt;
  return text ? read_survivors_(path, *text) : std::vector<Survivor>();
}

void Server::look_at_survivors() {
  outdated_ = outdated_ || std::any_of(survivors_.begin(), survivors_.end(),
                                       [this](const auto& shown) { return survivors_of(shown.first) != shown.second; });
}

// Some editors take another spelling of a URI for another document, so it is named as it was opened.
void Server::respell(Json& value) const {
  if (spellings_.empty()) return;
  if (value.is_string()) {
    const auto found = spellings_.find(value.get_ref<const std::string&>());
    if (found != spellings_.end()) value = found->second;
  } else if (value.is_array()) {
    for (Json& one : value) respell(one);
  } else if (value.is_object()) {
    Json named = Json::object();  // "changes" has the URIs as names
    for (auto& [name, one] : value.items()) {
      if (one.is_structured() || name == "uri" || name == "targetUri") respell(one);
      const auto found = spellings_.find(name);
      named[found == spellings_.end() ? name : found->second] = std::move(one);
    }
    value = std::move(named);
  }
}

void Server::respond(const Json& id, Json result) {
  respell(result);
  send_({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
}

void Server::refuse(const Json& id, ErrorCode code, const std::string& message) {
  send_(
      {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", static_cast<int>(code)}, {"message", message}}}});
}

}  // namespace ipos::tools::lsp
