// The handlers of the language server, in process: what each answers about small programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "compiler/format/format.hpp"
#include "tests/editor/client.hpp"
#include "tests/harness/contains.hpp"
#include "tools/lsp_base/transport.hpp"

namespace ipos::tests {
namespace {

const std::string kPath = "/p/A.IPC";

std::string hover_text(Client& client, int line, int character) {
  const Json hover = client.request("textDocument/hover", Client::at(kPath, line, character));
  return hover.is_null() ? "" : hover["contents"]["value"].get<std::string>();
}

std::vector<std::string> completions_in(Client& client, const std::string& path, int line, int character) {
  std::vector<std::string> labels;
  for (const Json& one : client.request("textDocument/completion", Client::at(path, line, character)))
    labels.push_back(one["label"]);
  return labels;
}

std::vector<std::string> completions(Client& client, int line, int character) {
  return completions_in(client, kPath, line, character);
}

bool has(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

TEST(LspDiagnostics, AllOfTheProgramAndItsHeaders) {
  Client client(std::map<std::string, std::string>{{"/p/h.h", "long shared;\nlong 5;\n"}});
  client.open(kPath, "#include \"h.h\"\nlong unused;\nmain() { shared = nothing; }\n");
  EXPECT_EQ(client.codes("/p/h.h").size(), 1U);
  client.open("/p/h.h", "long shared;\n");
  EXPECT_TRUE(client.codes("/p/h.h").empty());
  // E0201 unknown name, W0201 unused variable: docs/reference/diagnostics.
  EXPECT_TRUE(has(client.codes(kPath), "E0201"));
  client.notify("textDocument/didClose", Client::document("/p/h.h"));
  EXPECT_EQ(client.codes("/p/h.h").size(), 1U) << "the disk counts again";
}

// What is mended in one place is one problem: a macro stands at its first use and leads to the others, which are marked.
TEST(LspDiagnostics, AMacroIsToldOnceAndMarkedAtItsOtherUses) {
  Client client;
  client.open(kPath, "#define BIG (100000 * 65536)\nlong a;\nmain() {\n  a = BIG;\n  H1 = a;\n  a = BIG;\n  H2 = a;\n  a = BIG;\n  H3 = a; }\n");
  const Json& all = client.diagnostics["file://" + kPath];
  ASSERT_EQ(all.size(), 3U) << all;
  const auto line = [&](size_t n) { return all[n]["range"]["start"]["line"].get<int>(); };
  EXPECT_EQ(line(0), 3);
  EXPECT_EQ(all[0]["severity"], 2);
  std::vector<int> uses;
  for (const Json& one : all[0]["relatedInformation"])
    if (one["message"] == "the same in this use of the macro") uses.push_back(one["location"]["range"]["start"]["line"]);
  EXPECT_EQ(uses, (std::vector<int>{5, 7}));
  for (const size_t n : {1U, 2U}) {
    EXPECT_EQ(line(n), n == 1 ? 5 : 7);
    EXPECT_EQ(all[n]["severity"], 4) << "a hint: no row in the list of problems";
    EXPECT_EQ(all[n]["message"], all[0]["message"]);
    ASSERT_EQ(all[n]["relatedInformation"].size(), 1U);
    EXPECT_EQ(all[n]["relatedInformation"][0]["location"]["range"]["start"]["line"], 3);
  }
}

TEST(LspDiagnostics, AHeaderThatIsIncludedTwiceIsToldOnce) {
  Client client(std::map<std::string, std::string>{{"/p/h.h", "/* one /* two */\n"}});
  client.open(kPath, "#include \"h.h\"\n#include \"h.h\"\nmain() { H1 = 1; }\n");
  EXPECT_EQ(client.codes("/p/h.h").size(), 1U) << client.diagnostics["file:///p/h.h"];
}

TEST(LspDiagnostics, WhatIsWrittenTwiceIsToldTwice) {
  Client client;
  client.open(kPath, "long a;\nmain() {\n  a = 100000 * 65536; H1 = a;\n  a = 100000 * 65536; H1 = a; }\n");
  for (const Json& one : client.diagnostics["file://" + kPath]) EXPECT_EQ(one["severity"], 2);
  EXPECT_EQ(client.codes(kPath).size(), 2U);
}

// Two programs of a plant that do not meet: at the command of each, with the text of `ipos run`. A line more above it, and the
// message moves with its line; a text that is saved is looked at anew.
TEST(LspDiagnostics, ObjectsThatNobodyReceivesAreToldAcrossThePlant) {
  const std::string sender =
      "#include <const.h>\nSCTRCYCL Tr; long lData, lMore;\nmain()\n{\n  Tr.ObjectNo = 1100; Tr.CycleTime = 10; Tr.Format = 8; Tr.DPointer = "
      "numof(lData);\n  _SBusCommDef(SCD_TRCYCL, Tr);\n  _SBusCommOn();\n  while (1) lData = lMore++;\n}\n";
  const std::string receiver =
      "#include <const.h>\nSCREC Re; long lData, lMore;\nmain()\n{\n  Re.ObjectNo = 1101; Re.Format = 8; Re.DPointer = "
      "numof(lData);\n  _SBusCommDef(SCD_REC, Re);\n  _SBusCommOn();\n  while (1) H0 = lData + lMore;\n}\n";
  const std::string plant =
      "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"leader\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nsbus = "
      "\"sbus\"\n[station.parameters]\nP881 = 1\n[[station]]\nname = \"follower\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\nsbus = "
      "\"sbus\"\n[station.parameters]\nP881 = 2\n";
  Client client(std::map<std::string, std::string>{{"/p/B.IPC", receiver}});
  client.open("/p/p.toml", plant);
  client.open(kPath, sender);
  const auto found = [&](const std::string& path) {
    Json one;
    for (const Json& message : client.diagnostics["file://" + path])
      if (message["code"].get<std::string>().starts_with("B")) one = message;
    return one;
  };
  const Json sent = found(kPath), taken = found("/p/B.IPC");
  ASSERT_FALSE(sent.is_null());
  ASSERT_FALSE(taken.is_null());
  EXPECT_EQ(sent["code"], "B28");
  EXPECT_EQ(sent["message"], "nobody on sbus receives object 44Ch (1100), which leader sends here; follower expects 44Dh (1101)");
  EXPECT_EQ(sent["range"]["start"], (Json{{"line", 5}, {"character", 2}}));
  EXPECT_EQ(sent["relatedInformation"][0]["location"]["uri"], "file:///p/p.toml");
  EXPECT_EQ(taken["code"], "B29");

  const auto change = [&](const std::string& text) {
    client.notify("textDocument/didChange", {{"textDocument", {{"uri", "file://" + kPath}}}, {"contentChanges", {{{"text", text}}}}});
  };
  change("\n\n" + sender);
  EXPECT_EQ(found(kPath)["range"]["start"]["line"], 7);
  std::string mended = sender;
  mended.replace(mended.find("1100"), 4, "1101");
  change(mended);
  client.notify("textDocument/didSave", Client::document(kPath));
  EXPECT_TRUE(found(kPath).is_null()) << found(kPath);
  EXPECT_TRUE(found("/p/B.IPC").is_null()) << found("/p/B.IPC");
}

// 1-based places, as the tests of a program keep them; the ü is one unit of UTF-16 and two bytes.
TEST(LspDiagnostics, WhatNoTestNoticesIsInformation) {
  const std::string text = "long a;\nmain() { a = 5;/*\u00fc*/ a = 66; }\n";
  std::vector<tools::Survivor> kept{{2, 14, "5 became 6", true}, {2, 27, "66 became 72", false}, {9, 1, "a line that is not there", true}};
  Client client;
  client.server().show_survivors([&](const std::string& path, std::string_view of) {
    return path == kPath && of == text ? kept : std::vector<tools::Survivor>();
  });
  client.open(kPath, text);
  const auto shown = [&] {
    std::vector<std::string> all;
    for (const Json& one : client.diagnostics["file://" + kPath])
      if (one["source"] == "ipos test") {
        EXPECT_EQ(one["severity"], 3);
        all.push_back(one["range"].dump() + one["message"].get<std::string>());
      }
    return all;
  };
  const auto range = [](int begin, int end) {
    return Json{{"start", {{"line", 1}, {"character", begin}}}, {"end", {{"line", 1}, {"character", end}}}}.dump();
  };
  EXPECT_EQ(shown(), (std::vector<std::string>{range(13, 14) + "no test notices: 5 became 6", range(25, 27) + "no test reaches: 66 became 72"}));

  kept.pop_back();
  kept.pop_back();
  client.settle();
  EXPECT_EQ(shown().size(), 2U) << "nobody has looked";
  client.server().look_at_survivors();
  client.settle();
  EXPECT_EQ(shown().size(), 1U);

  client.notify("textDocument/didChange", {{"textDocument", {{"uri", "file://" + kPath}}}, {"contentChanges", {{{"text", text + "\n"}}}}});
  EXPECT_TRUE(shown().empty()) << "tests have not seen this text";
}

// As vscode-languageserver-textdocument does it: CR LF, LF and CR end lines, a character behind the end of a line is its
// end, in front of the CR.
size_t offset_in_document(const std::string& text, const Json& position) {
  size_t at = 0;
  for (int line = position["line"]; line > 0; --line) {
    at = text.find_first_of("\r\n", at);
    if (at == std::string::npos) return text.size();
    at += text.compare(at, 2, "\r\n") == 0 ? 2 : 1;
  }
  const size_t end = std::min(text.find_first_of("\r\n", at), text.size());
  return std::min(at + position["character"].get<size_t>(), end);
}

std::string formatted(const std::string& text) {
  Client client;
  client.open(kPath, text);
  std::string out = text;
  for (const Json& edit : client.request("textDocument/formatting", Client::document(kPath))) {
    const size_t begin = offset_in_document(out, edit["range"]["start"]);
    const size_t end = offset_in_document(out, edit["range"]["end"]);
    out.replace(begin, end - begin, edit["newText"].get<std::string>());
  }
  return out;
}

std::string with_ends(std::string text, const std::string& end) {
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) text.replace(at, 1, end);
  return text;
}

// The document of the editor becomes what `ipos fmt` writes, whatever ends its lines, and then stays as it is.
TEST(LspFormatting, GivesWhatTheFormatterGives) {
  const char* texts[] = {"long x;\nmain()\n{\nx=2;\n}\n",
                         "long x;\nmain()\n{\n    x = 2;\n}\n",
                         "long x;\n\n\n\nmain()\n\n\n{\n    x = 2; // a\n}\n",
                         "long x;\nmain() { x=2; }",
                         "\n\nlong x;   \nmain()\n{\nx=2;   \n}",
                         "long x;\nmain()\n{\n  if (x) {\n  x=1; }\n else x=2;\n /* a\n b */\n}\n\n\n"};
  for (const std::string text : texts)
    for (const std::string& all : {with_ends(text, "\n"), with_ends(text, "\r\n"),
                                   with_ends(text.substr(0, text.size() / 2), "\r\n") + text.substr(text.size() / 2),
                                   text.substr(0, text.size() / 2) + with_ends(text.substr(text.size() / 2), "\r\n")}) {
      const auto wanted = compiler::format_source(all);
      ASSERT_TRUE(wanted) << all;
      EXPECT_EQ(formatted(all), *wanted) << Json(all);
      EXPECT_EQ(formatted(*wanted), *wanted) << Json(all);
    }
}

TEST(LspDiagnostics, ACrAloneEndsALine) {
  Client client;
  client.open(kPath, "long q;\r// a\r\nmain() { q = zz; }\n");
  for (const Json& one : client.diagnostics["file://" + kPath])
    if (one["code"] == "E0201") {
      EXPECT_EQ(one["range"]["start"]["line"], 2) << one;
      EXPECT_EQ(one["range"]["start"]["character"], 13) << one;
    }
  client.notify("textDocument/didChange",
                {{"textDocument", {{"uri", "file://" + kPath}}},
                 {"contentChanges", {{{"range", {{"start", {{"line", 2}, {"character", 13}}}, {"end", {{"line", 2}, {"character", 15}}}}}, {"text", "7"}}}}});
  EXPECT_FALSE(has(client.codes(kPath), "E0201"));
}

// A text that is cut in the middle of an emoji.
TEST(LspDocuments, HalfASurrogatePairIsAReplacement) {
  Client client;
  const auto open = [&](const std::string& text) {
    client.server().receive(R"({"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":"file:///p/A.IPC","text":")" +
                            text + R"("}}})");
    client.settle();
    return client.diagnostics["file:///p/A.IPC"];
  };
  for (const char* half : {"\\ud83d", "\\uDE00", "\\ud83d\\ud83d\\ude00", "\\ud83dx", "\xff", "\xed\xa0\xbd", "\\\\\\ud83d"}) {
    const Json shown = open(std::string("long q; // ") + half + " \\\"\\nmain() { q = zz; }\\n");
    ASSERT_EQ(shown.size(), 1U) << half;
    EXPECT_EQ(shown[0]["code"], "E0201") << half;
    EXPECT_EQ(shown[0]["range"]["start"]["line"], 1) << half;
    open("main() { }\\n");
  }
}

TEST(LspDocuments, OtherSchemesAreDocumentsToo) {
  for (const std::string uri : {"untitled:A.IPC", "vscode-vfs://github/owner/A.IPC", "vscode-vfs://github/a/../b/A.IPC",
                                "FILE:///p/A.IPC", "File://host/p/A.IPC", "zipfile:///x.zip/A.IPC", "git:/p/A.IPC?ref"}) {
    Client client;
    client.notify("textDocument/didOpen", {{"textDocument", {{"uri", uri}, {"text", "long q;\nmain() { q = zz; }\n"}}}});
    ASSERT_EQ(client.diagnostics.count(uri), 1U) << uri << ": another spelling";
    std::vector<std::string> codes;
    for (const Json& one : client.diagnostics[uri]) codes.push_back(one["code"]);
    if (uri.find(".IPC?") == std::string::npos) {
      EXPECT_EQ(codes, std::vector<std::string>{"E0201"}) << uri;
    }
  }
}

// All that an answer says of a document has the spelling that the editor has opened it under.
TEST(LspDocuments, KeepTheSpellingOfTheirUri) {
  for (const std::string uri : {"file:///p/Stra\xc3\x9f" "e.IPC", "file://localhost/p/B.IPC", "file:///p/%41.IPC"}) {
    Client client;
    client.notify("textDocument/didOpen", {{"textDocument", {{"uri", uri}, {"text", "long q;\nmain() { q = zz; }\n"}}}});
    ASSERT_EQ(client.diagnostics.size(), 1U);
    EXPECT_EQ(client.diagnostics.begin()->first, uri);
    const Json at{{"textDocument", {{"uri", uri}}}, {"position", {{"line", 1}, {"character", 9}}}};
    EXPECT_EQ(client.request("textDocument/definition", at)[0]["uri"], uri);
    Json rename = at;
    rename["newName"] = "r";
    const Json changes = client.request("textDocument/rename", rename)["changes"];
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes.begin().key(), uri);
    client.notify("textDocument/didClose", {{"textDocument", {{"uri", uri}}}});
    EXPECT_TRUE(client.diagnostics[uri].empty());
  }
}

// A forgotten header: thousands of messages would stop an editor.
TEST(LspDiagnostics, EndAfterAHundredErrors) {
  std::string text = "main()\n{\n";
  for (int n = 0; n < 20'000; ++n) text += "  x" + std::to_string(n) + " = 1;\n";
  Client client;
  client.open(kPath, text + "}\n");
  EXPECT_EQ(client.codes(kPath).size(), 101U);
  EXPECT_EQ(client.codes(kPath).back(), "E0177");
}

TEST(LspDiagnostics, OptionsOfTheClient) {
  Client client({}, {{"defines", {"SPEED=5"}}, {"unit", "mdxb"}, {"warnings", {"error=unused-variable"}}});
  client.open(kPath, "long unused;\nmain() { H1000 = SPEED; }\n");
  ASSERT_EQ(client.codes(kPath), std::vector<std::string>{"W0201"});
  EXPECT_EQ(client.diagnostics["file://" + kPath][0]["severity"], 1);
  EXPECT_EQ(client.diagnostics["file://" + kPath][0]["tags"], Json({1}));
}

// Information, as the program is good.
TEST(LspDiagnostics, AVariableWithTheNameOfAValueOfTheUnit) {
  Client client;
  client.open(kPath, "long speed;\nmain() { speed = 5; }\n");
  ASSERT_EQ(client.codes(kPath), std::vector<std::string>{"N0219"});
  EXPECT_EQ(client.diagnostics["file://" + kPath][0]["severity"], 3);
}

TEST(LspDiagnostics, AtomicAsInTheBuild) {
  const std::string source =
      "#include <constb.h>\nlong x, y;\nmain() { _SetTask2(T2_START, T); while (1) x = (x + 1) % 8; }\n"
      "T() { y = x; }\n";
  Client plain;
  plain.open(kPath, source);
  EXPECT_EQ(plain.codes(kPath), std::vector<std::string>{"W0240"});
  Client atomic({}, {{"atomic", true}});
  atomic.open(kPath, source);
  EXPECT_TRUE(atomic.codes(kPath).empty());
}

TEST(LspHover, VariablesMembersAndElements) {
  Client client;
  client.open(kPath,
              "typedef struct { long a; long b[2]; } T; // a pair\nT t[2];\ninitial long kept; // stays\n"
              "main() { t[1].b[1] = kept; H0 = t[H1].a; f(); }\n// helps\nf() { }\n");
  EXPECT_TRUE(contains(hover_text(client, 3, 9), "H420..H425"));   // t
  EXPECT_TRUE(contains(hover_text(client, 3, 14), "H424..H425"));  // b of t[1]
  EXPECT_TRUE(contains(hover_text(client, 3, 22), "kept at power-off"));
  EXPECT_TRUE(contains(hover_text(client, 3, 22), "stays"));
  EXPECT_TRUE(contains(hover_text(client, 3, 38), "variable 0 of T"));  // a of t[H1]
  EXPECT_TRUE(contains(hover_text(client, 3, 41), "helps"));
  EXPECT_TRUE(contains(hover_text(client, 1, 0), "long[2] b;"));
}

TEST(LspHover, WhatTheManualsSay) {
  Client client;
  client.open(kPath,
              "#include <const.h>\nmain() { H490 = 0x10; ActPos_Mot; _SBusCommOn(); } // P130 and F10\n");
  EXPECT_TRUE(contains(hover_text(client, 1, 10), "WdogTimer"));
  EXPECT_TRUE(contains(hover_text(client, 1, 10), "IPOSplus p. 34"));
  EXPECT_EQ(hover_text(client, 1, 17), "16 = 0x10 = 0b10000\n");
  EXPECT_TRUE(contains(hover_text(client, 1, 36), "SCOMON"));
  EXPECT_TRUE(contains(hover_text(client, 1, 36), "IPOSplus p. 319"));
  EXPECT_TRUE(contains(hover_text(client, 1, 55), "8470"));  // 1053 1610 p. 70: P130 has index 8470
  EXPECT_TRUE(contains(hover_text(client, 1, 64), "IPOS illegal command"));
  EXPECT_EQ(hover_text(client, 1, 8), "");
}

TEST(LspCompletion, ByPlace) {
  Client client;
  client.open(kPath,
              "#include <\n#pragma \n#\ntypedef struct { long a; MOVLNK b; } T;\nT t; T v[2];\n"
              "main() {\n  t.b.;\n  v[0].;\n  v.;\n  // x.\n  \n}\n");
  EXPECT_TRUE(has(completions(client, 0, 10), "const.h"));
  EXPECT_EQ(completions(client, 1, 8), (std::vector<std::string>{"globals", "initials", "var", "list"}));
  EXPECT_TRUE(has(completions(client, 2, 1), "define"));
  EXPECT_TRUE(has(completions(client, 6, 6), "BusType"));
  EXPECT_EQ(completions(client, 7, 7), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(completions(client, 8, 4).empty());
  EXPECT_TRUE(completions(client, 9, 7).empty());
  const auto names = completions(client, 10, 2);
  for (const char* name : {"t", "T", "_Wait", "while", "SCREC"}) EXPECT_TRUE(has(names, name)) << name;
  for (const char* name : {"goto", "sizeof", "int", "BusType"}) EXPECT_FALSE(has(names, name)) << name;
}

// _GoAbs takes GO_WAIT or GO_NOWAIT, then a value; _SetTask2 its mode, then a function of the program (system functions of
// IPOSplus). What else is known stays, behind it.
TEST(LspCompletion, InsideACallWhatFitsTheArgumentComesFirst) {
  Client client;
  client.open(kPath,
              "#include <constb.h>\nlong lTarget;\nWork() { }\nmain() {\n  _GoAbs( ;\n  _GoAbs(GO_WAIT, ;\n  _SetTask2( ;\n"
              "  _SetTask2(T2_START, ;\n  _GetSys( ;\n  \n}\n");
  const auto first = [&](int line, int character, size_t count) {
    auto names = completions(client, line, character);
    EXPECT_TRUE(has(names, "lTarget") && has(names, "_Wait") && has(names, "while"));
    names.resize(std::min(names.size(), count));
    return names;
  };
  EXPECT_EQ(first(4, 10, 2), (std::vector<std::string>{"GO_NOWAIT", "GO_WAIT"}));
  EXPECT_FALSE(has(first(5, 18, 2), "GO_WAIT"));
  EXPECT_TRUE(has(first(6, 13, 2), "T2_START"));
  EXPECT_TRUE(has(first(7, 22, 2), "Work"));
  EXPECT_TRUE(has(completions(client, 8, 10), "lTarget"));
  EXPECT_EQ(completions(client, 8, 10).front().find('_'), std::string::npos) << "a variable";
  for (const int line : {4, 9}) EXPECT_FALSE(has(completions(client, line, 2), "CONSTB_H")) << "a guard of a header";
  const Json items = client.request("textDocument/completion", Client::at(kPath, 4, 10));
  EXPECT_EQ(items[0]["sortText"].get<std::string>()[0], '0');
  EXPECT_EQ(items[2]["sortText"].get<std::string>()[0], '1');
  const Json help = client.request("textDocument/signatureHelp", Client::at(kPath, 4, 9));
  EXPECT_EQ(help["signatures"][0]["parameters"][0]["documentation"], "GO_NOWAIT, GO_WAIT");
}

TEST(LspRename, MacrosTheirUsesAndTheirBodies) {
  Client client;
  client.open(
      kPath,
      "#define A B\n#define B v\n#define UNUSED (v + A)\n#ifdef A\nlong v;\n#endif\nmain() { A = B + v; }\n");
  const auto renamed = [&](int line, int character) {
    Json params = Client::at(kPath, line, character);
    params["newName"] = "other";
    const Json answer = client.request("textDocument/rename", params);
    return answer.is_null() ? size_t{0} : answer["changes"]["file://" + kPath].size();
  };
  EXPECT_EQ(renamed(6, 9), 4U);   // A: #define, UNUSED, #ifdef, main
  EXPECT_EQ(renamed(6, 13), 3U);  // B: #define, A's text, main
  EXPECT_EQ(renamed(6, 17), 4U);  // v: B's text, UNUSED, declaration, main
}

TEST(LspRename, WorksInAProgramWithMistakesButAddsNone) {
  Client client;
  client.open(kPath, "long a; long b;\nmain() { a = nothing; b = 1; }\n");
  Json params = Client::at(kPath, 0, 5);
  params["newName"] = "c";
  EXPECT_EQ(client.request("textDocument/rename", params)["changes"]["file://" + kPath].size(), 2U);
  params["newName"] = "b";
  EXPECT_EQ(client.refused("textDocument/rename", params), -32803);
}

TEST(LspRename, AMacroOfTheSameNameIsAClash) {
  Client client;
  client.open(kPath, "#define X 5\nlong a;\nmain() { a = 1; H0 = a; }\n");
  Json params = Client::at(kPath, 1, 5);
  params["newName"] = "X";
  EXPECT_EQ(client.refused("textDocument/rename", params), -32803);
}

TEST(LspReferences, WithAndWithoutTheDeclaration) {
  Client client;
  client.open(kPath, "long a;\nmain() { a++; H7 = a; H007 = 2; }\n");
  const auto count = [&](int line, int character, bool declaration) {
    Json params = Client::at(kPath, line, character);
    params["context"] = {{"includeDeclaration", declaration}};
    return client.request("textDocument/references", params).size();
  };
  EXPECT_EQ(count(0, 5, true), 3U);
  EXPECT_EQ(count(0, 5, false), 2U);
  EXPECT_EQ(count(1, 15, true), 2U);  // H7 is H007
  EXPECT_EQ(client.request("textDocument/documentHighlight", Client::at(kPath, 1, 9)).size(), 3U);
}

TEST(LspSymbols, ExtentsHoldTheirNames) {
  Client client;
  client.open(kPath, "#define A \\\n  1\nlong a, b;\nmain()\n{\n  a = 1;\n}\n");
  const Json outline = client.request("textDocument/documentSymbol", Client::document(kPath));
  ASSERT_EQ(outline.size(), 4U);
  for (const Json& one : outline) {
    EXPECT_LE(one["range"]["start"]["line"], one["selectionRange"]["start"]["line"]) << one;
    EXPECT_GE(one["range"]["end"]["line"], one["selectionRange"]["end"]["line"]) << one;
    if (one["name"] == "main") {
      EXPECT_EQ(one["range"]["end"]["line"], 6);
    }
  }
}

TEST(LspFormatting, RefusesWhatIposFmtRefuses) {
  Client client;
  client.open(kPath, "main() { /* open\n");
  EXPECT_EQ(client.refused("textDocument/formatting", Client::document(kPath)), -32803);
  client.open(kPath, "main()\n{\n}\n");
  EXPECT_TRUE(client.request("textDocument/formatting", Client::document(kPath)).empty());
}

TEST(LspServer, LifeCycle) {
  Client client;
  EXPECT_EQ(client.refused("initialize", Json::object()), -32600);
  EXPECT_EQ(client.refused("nonsense", Json::object()), -32601);
  client.server().receive("{no json");
  client.settle();
  ASSERT_EQ(client.strays.size(), 1U);
  EXPECT_EQ(client.strays[0]["error"]["code"], -32700);
  EXPECT_TRUE(client.ask("shutdown", nullptr).contains("result"));
  EXPECT_EQ(client.refused("textDocument/hover", Client::at(kPath, 0, 0)), -32600);
  client.notify("exit", nullptr);
  EXPECT_TRUE(client.server().ended());
  EXPECT_EQ(client.server().exit_code(), 0);
}

TEST(LspServer, ACancelledRequestIsNotCarriedOut) {
  Client client;
  client.open(kPath, "main() { }\n");
  const Json hover{
      {"jsonrpc", "2.0"}, {"id", 77}, {"method", "textDocument/hover"}, {"params", Client::at(kPath, 0, 1)}};
  client.server().receive(hover.dump());
  client.server().receive(R"({"jsonrpc":"2.0","method":"$/cancelRequest","params":{"id":77}})");
  client.server().receive(R"({"jsonrpc":"2.0","method":"$/cancelRequest","params":{"id":12345}})");
  client.settle();
  EXPECT_FALSE(client.server().waiting());
}

TEST(LspTransport, CutsTheStreamIntoMessages) {
  tools::lsp::MessageReader reader;
  const std::string stream = tools::lsp::framed("{}") + "Garbage\r\n\r\n" +
                             "content-length: 3\r\nContent-Type: x\r\n\r\nabc" + tools::lsp::framed("");
  std::vector<std::string> bodies;
  for (const char c : stream) {
    reader.feed({&c, 1});
    while (const auto body = reader.next()) bodies.push_back(*body);
  }
  EXPECT_EQ(bodies, (std::vector<std::string>{"{}", "abc", ""}));
  reader.feed("Content-Length: 99999999999999\r\n\r\n");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.broken());
}

// The largest message and header, and one byte more.
TEST(LspTransport, HasALargestMessageAndAnEndOfItsHeader) {
  using tools::lsp::kMaxHeader, tools::lsp::kMaxMessage;
  tools::lsp::MessageReader reader;
  reader.feed("Content-Length: " + std::to_string(kMaxMessage) + "\r\n\r\n");
  const std::string piece(1U << 20U, 'x');
  for (size_t n = 0; n < kMaxMessage / piece.size(); ++n) {
    ASSERT_FALSE(reader.next());
    ASSERT_FALSE(reader.broken());
    reader.feed(piece);
  }
  reader.feed(tools::lsp::framed("{}"));
  const auto largest = reader.next();
  ASSERT_TRUE(largest);
  EXPECT_EQ(largest->size(), kMaxMessage);
  EXPECT_EQ(reader.next(), "{}");
  reader.feed("Content-Length: " + std::to_string(kMaxMessage + 1) + "\r\n\r\n");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.broken()) << "it is not waited for";
  const auto header = [](size_t size) {
    const std::string fields = "Content-Length: 2\r\nX: ";
    return fields + std::string(size - fields.size(), 'x');
  };
  for (const size_t size : {kMaxHeader, kMaxHeader + 1})
    for (const bool in_one : {false, true}) {
      tools::lsp::MessageReader other;
      other.feed(header(size));
      for (const char* part : {"\r", "\n\r", "\n{}"}) {
        if (!in_one) {
          EXPECT_FALSE(other.next());
        }
        other.feed(part);
      }
      EXPECT_EQ(other.next().has_value(), size == kMaxHeader) << size << in_one;
      EXPECT_EQ(other.broken(), size > kMaxHeader) << size << in_one;
    }
}

// --- plants and tests

const std::string kPlant = "/p/line.toml";
const std::string kStation =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n\n[[station]]\nname = \"u\"\nunit = \"mdxb\"\nsbus = "
    "\"sbus\"\n";

std::vector<std::string> messages(Client& client, const std::string& path) {
  std::vector<std::string> all;
  for (const Json& one : client.diagnostics["file://" + path])
    all.push_back(std::to_string(one["range"]["start"]["line"].get<int>()) + ":" +
                  one["message"].get<std::string>());
  return all;
}

TEST(LspPlants, DiagnosticsAreThoseOfTheRun) {
  Client client;
  client.open(kPlant, kStation + "colour = 1\n[station.parameters]\nP9999 = 1\n");
  ASSERT_EQ(messages(client, kPlant).size(), 2U);  // all in one round, as `ipos run`
  EXPECT_TRUE(contains(messages(client, kPlant)[1], "P9999")) << messages(client, kPlant)[1];
  EXPECT_TRUE(
      messages(client, kPlant)[0].starts_with("8:unknown key 'colour' in [[station]]; known are name, unit"));
  client.open("/p/b.toml", kStation + "[station.parameters]\nP9999 = 1\nP302 = 99999999\n");
  const auto refused = messages(client, "/p/b.toml");
  ASSERT_EQ(refused.size(), 2U);
  EXPECT_TRUE(contains(refused[0], "9:station 'u'") && contains(refused[0], "P9999")) << refused[0];
  EXPECT_TRUE(contains(refused[1], "10:station 'u'") && contains(refused[1], "too large")) << refused[1];
  client.open("/p/other.toml", "[tool]\nname = 1\n");
  EXPECT_TRUE(messages(client, "/p/other.toml").empty()) << "no plant";
}

TEST(LspPlants, CompletionOffersWhatTheReadersKnow) {
  Client client;
  client.open(kPlant,
              kStation + "\n\n[station.parameters]\nP130 = \n\nP100 = \"\"\n[[fault]]\nkind = \n[[\n");
  const auto keys = completions_in(client, kPlant, 8, 0);
  EXPECT_TRUE(has(keys, "firmware") && has(keys, "nvram") && !has(keys, "baud"));
  EXPECT_TRUE(has(completions_in(client, kPlant, 6, 9), "\"md60a\""));
  EXPECT_TRUE(has(completions_in(client, kPlant, 7, 8), "\"sbus\""));
  const auto parameters = completions_in(client, kPlant, 12, 0);
  EXPECT_TRUE(has(parameters, "P130") && !has(parameters, "P000")) << "what can be written";
  EXPECT_TRUE(has(completions_in(client, kPlant, 13, 9), "\"SBus 1\"") ||
              has(completions_in(client, kPlant, 13, 9), "\"SBus\""));
  EXPECT_TRUE(has(completions_in(client, kPlant, 15, 7), "\"corrupt\""));
  EXPECT_TRUE(has(completions_in(client, kPlant, 16, 2), "station"));
}

// Label to detail of what is offered at the end of the last row.
std::map<std::string, std::string> offered_behind(const std::string& path, const std::string& text) {
  Client client;
  client.open(path, text);
  const int line = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  const auto column = static_cast<int>(text.size() - (text.rfind('\n') + 1));
  std::map<std::string, std::string> offered;
  for (const Json& one : client.request("textDocument/completion", Client::at(path, line, column)))
    offered[one["label"]] = one.value("detail", "");
  return offered;
}

// P130 0..2000 s, 2 s from the factory (11264926, parameter list); rates of the lines 1053 1610 p. 8 and EN 50170; DP
// switches 0..127; an SBus address 1053 1610 p. 39.
TEST(LspPlants, CompletionShowsRanges) {
  using Offered = std::map<std::string, std::string>;
  const std::string parameters = kStation + "[station.parameters]\n";
  Client client;
  client.open(kPlant, parameters);
  std::string detail, text;
  for (const Json& one : client.request("textDocument/completion", Client::at(kPlant, 9, 0)))
    if (one["label"] == "P130") {
      detail = one["detail"];
      text = one["documentation"]["value"];
    }
  EXPECT_EQ(detail, "Ramp t11 UP CW: 0.000 s..2000.000 s, factory setting 2.000 s");
  EXPECT_TRUE(contains(text, "shown in s") && contains(text, "- 0.000 s..2000.000 s\n") &&
              contains(text, "- factory setting 2.000 s"))
      << text;
  const auto values = offered_behind(kPlant, parameters + "P130 = ");
  EXPECT_EQ(values, (Offered{{"\"2.000 s\"", "factory setting; 0.000 s..2000.000 s"},
                             {"\"0.000 s\"", "smallest; 0.000 s..2000.000 s"},
                             {"\"2000.000 s\"", "largest; 0.000 s..2000.000 s"}}));
  const std::string bus = "[[bus]]\nname = \"b\"\n";
  EXPECT_EQ(offered_behind(kPlant, bus + "kind = \"can\"\nbaud = "),
            (Offered{{"125000", ""}, {"250000", ""}, {"500000", ""}, {"1000000", ""}}));
  EXPECT_EQ(offered_behind(kPlant, bus + "kind = \"rs485\"\nbaud = "),
            (Offered{{"9600", ""}, {"57600", ""}}));
  EXPECT_EQ(offered_behind(kPlant, bus + "shielded = "), (Offered{{"true", ""}, {"false", ""}}));
  EXPECT_EQ(offered_behind(kPlant, kStation + "option = \"dfp\"\nprofibus_address = "),
            (Offered{{"0", "0 to 127"}, {"127", "0 to 127"}}));
  EXPECT_EQ(offered_behind(kPlant, kStation + "[station.load]\ninertia = "),
            (Offered{{"0", "0 to 100000 %"}, {"100000", "0 to 100000 %"}}));
  EXPECT_EQ(offered_behind(kPlant, kStation + "[station.inputs]\nDI01 = "),
            (Offered{{"0", ""}, {"1", ""}, {"true", ""}, {"false", ""}}));
  const std::string control = "[[control]]\nname = \"plc\"\nsbus = \"sbus\"\n";
  EXPECT_EQ(offered_behind(kPlant, kStation + control + "[[control.target]]\naddress = "),
            (Offered{{"0", "0 to 63"}, {"63", "0 to 63"}}));
  EXPECT_EQ(offered_behind("/p/a.test.toml", "plant = \"plant.toml\"\nspeed = "),
            (Offered{{"0", "0 to 1000000"}, {"1000000", "0 to 1000000"}}));
}

TEST(LspPlants, HoverKnowsTheParametersOfTheUnit) {
  Client client;
  client.open(kPlant, kStation + "[station.parameters]\nP130 = \"2.5 s\"\n");
  const Json hover = client.request("textDocument/hover", Client::at(kPlant, 9, 1));
  ASSERT_FALSE(hover.is_null());
  const std::string text = hover["contents"]["value"];
  EXPECT_TRUE(contains(text, "**P130 ") && contains(text, "index 8470")) << text;
  EXPECT_TRUE(client.request("textDocument/hover", Client::at(kPlant, 6, 1)).is_null());
  EXPECT_TRUE(client.request("textDocument/documentHighlight", Client::at(kPlant, 6, 1)).is_null());
}

TEST(LspPlants, TheProgramOfAStationIsItsDefinition) {
  Client client;
  client.open(kPlant, kStation + "program = \"A.IPC\"\n");
  const Json place = client.request("textDocument/definition", Client::at(kPlant, 8, 13));
  EXPECT_EQ(place["uri"], "file:///p/A.IPC");
  const Json symbols = client.request("textDocument/documentSymbol", Client::document(kPlant));
  ASSERT_EQ(symbols.size(), 2U);
  EXPECT_EQ(symbols[1]["name"], "station \"u\"");
}

}  // namespace
}  // namespace ipos::tests
