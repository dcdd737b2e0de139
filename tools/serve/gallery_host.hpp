// The host of a page without a plant: it shows the examples and the plants of the folder, opens one, or makes a new one.
#pragma once

#include <functional>
#include <string>

#include "tools/serve/channel.hpp"
#include "tools/serve/host/router.hpp"

namespace ipos::tools::serve {

class GalleryHost {
 public:
  // `read_only`: why no files are written; empty: they are. `build` reads and compiles a plant; a Failure: it cannot be opened.
  using Build = std::function<void(const std::string& path)>;
  GalleryHost(Mailbox& mailbox, std::string version, std::string read_only, Build build);

  // The path of the plant that was opened; empty: nobody listens any more.
  std::string run();

  Router& router() { return router_; }

 private:
  Json list() const;
  Json open(const Arguments& a);
  Json make(const Arguments& a);
  void must_write() const;
  Json enter(const std::string& path);

  Mailbox& mailbox_;
  SteadyClock clock_;
  Router router_;
  std::string version_;
  std::string read_only_;
  Build build_;
  std::string opened_;
};

}  // namespace ipos::tools::serve
