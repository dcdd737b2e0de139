// Broken texts: programs of the project, cut and shuffled by a fixed sequence. Every request has an answer,
// and edits by ranges leave the text that the editor has.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/editor/client.hpp"
#include "tools/lsp_base/positions.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
const std::string kPath = "/p/A.IPC";

std::vector<std::string> texts() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / "tests/language"))
    if (entry.path().extension() == ".IPC") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> out;
  for (size_t n = 0; n < paths.size(); n += 7) {
    std::ifstream in(paths[n], std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    out.push_back(text.str().substr(0, 4000));
  }
  return out;
}

void ask_everything(Client& client, int line, int character) {
  for (const char* method : {"hover", "completion", "signatureHelp", "definition", "references",
                             "documentHighlight", "prepareRename"})
    EXPECT_FALSE(
        client.ask(std::string("textDocument/") + method, Client::at(kPath, line, character)).is_null())
        << method;
  Json params = Client::at(kPath, line, character);
  params["newName"] = "other";
  EXPECT_FALSE(client.ask("textDocument/rename", params).is_null());
  EXPECT_FALSE(client.ask("textDocument/documentSymbol", Client::document(kPath)).is_null());
  EXPECT_FALSE(client.ask("textDocument/formatting", Client::document(kPath)).is_null());
  params["range"] = {{"start", params["position"]}, {"end", params["position"]}};
  for (const char* method : {"foldingRange", "inlayHint", "semanticTokens/full", "codeLens", "codeAction"})
    EXPECT_FALSE(client.ask(std::string("textDocument/") + method, params).is_null()) << method;
}

TEST(LspRobust, EveryRequestOnBrokenTextsIsAnswered) {
  std::mt19937 random(1);
  Client client;
  client.open(kPath, "");
  for (std::string text : texts()) {
    for (int round = 0; round < 3 && !text.empty(); ++round) {
      const size_t at = random() % text.size();
      switch (round) {
        case 0: text.erase(at, random() % 20); break;
        case 1: text.insert(at, 1, "{}()[];#\"/*.\\\xFF"[random() % 14]); break;
        default: text.resize(at); break;
      }
      // A message is valid UTF-8, whatever its text was on disk.
      const Json sent = Json::parse(Json(text).dump(-1, ' ', true, Json::error_handler_t::replace));
      Json params = Client::document(kPath);
      params["contentChanges"] = Json::array({{{"text", sent}}});
      client.notify("textDocument/didChange", params);
      ask_everything(client, static_cast<int>(random() % 40), static_cast<int>(random() % 40));
    }
  }
}

TEST(LspRobust, EditsByRangeGiveTheEditorsText) {
  std::mt19937 random(2);
  for (const tools::lsp::Encoding encoding : {tools::lsp::Encoding::Utf16, tools::lsp::Encoding::Utf8}) {
    tools::lsp::Workspace workspace([](const std::string&) { return std::optional<std::string>(); });
    workspace.encoding = encoding;
    std::string mine = "long a; // \xC3\xBC \xF0\x9F\x99\x82\nmain() { }\n";
    workspace.open(kPath, mine);
    for (int n = 0; n < 300; ++n) {
      // Whole characters only, as editors do: places where the position leads back to the offset.
      const auto whole = [&] {
        const auto offset = static_cast<uint32_t>(random() % (mine.size() + 1));
        return tools::lsp::offset_of(mine, tools::lsp::position_of(mine, offset, encoding), encoding);
      };
      const auto [begin, end] = std::minmax({whole(), whole()});
      const std::string added =
          std::vector<std::string>{"", "x", "\n", "\xC3\xBC", "\xF0\x9F\x99\x82"}[random() % 5];
      const Json range = tools::lsp::range_of(mine, begin, std::min(end, begin + 5), encoding);
      const uint32_t last = tools::lsp::offset_of(mine, range["end"], encoding);
      mine.replace(begin, last - begin, added);
      workspace.change(kPath, Json::array({{{"range", range}, {"text", added}}}));
      ASSERT_EQ(workspace.text(kPath), mine) << n;
    }
  }
}

TEST(LspRobust, PositionsAndUrisThatMakeNoSense) {
  Client client;
  client.open(kPath, "main() { }\n");
  for (const int line : {-5, 0, 99, 2147483647})
    for (const int character : {-5, 0, 99, 2147483647}) ask_everything(client, line, character);
  for (const char* uri :
       {"", "file://", "untitled:Untitled-1", "file:///%zz%4", "http://x/y.IPC", "ipos:/const.h"}) {
    Json params = Client::at(kPath, 0, 0);
    params["textDocument"]["uri"] = uri;
    EXPECT_FALSE(client.ask("textDocument/hover", params).is_null()) << uri;
  }
  for (const char* params :
       {"null", "[]", "{}", R"({"textDocument":null})", R"({"textDocument":{"uri":5}})",
        R"({"textDocument":{"uri":"file:///p/A.IPC"},"position":{"line":"x","character":{}}})"})
    for (const char* method : {"hover", "rename", "documentSymbol", "formatting", "references"})
      EXPECT_FALSE(client.ask(std::string("textDocument/") + method, Json::parse(params)).is_null());
}

TEST(LspPositions, UrisLeadBack) {
  for (const char* path : {"/a/b c/\xC3\xA4%.IPC", "/x", "C:/dir/A.IPC"})
    EXPECT_EQ(tools::lsp::path_of(tools::lsp::uri_of(path)), path);
  EXPECT_EQ(tools::lsp::path_of("file:///c%3A/x.IPC"), "c:/x.IPC");
  EXPECT_EQ(tools::lsp::uri_of("const.h"), "ipos:/const.h");
  EXPECT_EQ(tools::lsp::uri_of("untitled:Untitled-1"), "untitled:Untitled-1");
}

}  // namespace
}  // namespace ipos::tests
