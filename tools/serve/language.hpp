// The language server beside the plant: what editors are told of its programs, plants and tests the page is told, too.
#pragma once

#include <optional>

#include "tools/input/program.hpp"
#include "tools/lsp/server.hpp"
#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

class LanguageServer final : public Language {
 public:
  // As the plant's programs are compiled. `survivors`: what no test has noticed, where somebody keeps that.
  explicit LanguageServer(const CompileFlags& compile, lsp::ReadSurvivors survivors = {});

  Json answer(const std::string& method, const Json& params, const Texts& texts) override;

 private:
  Json say(const char* method, Json params, bool wants_reply);
  void show(const Texts& texts);

  lsp::Server server_;
  Json options_;
  Texts shown_;       // open documents
  Json reply_;        // to the request that is asked
  Json diagnostics_ = Json::object();  // by URI
  int asked_ = 0;
};

}  // namespace ipos::tools::serve
