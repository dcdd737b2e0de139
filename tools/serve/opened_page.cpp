// A page that leads to another one at once.
#include "tools/serve/opened_page.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "tools/serve/browser.hpp"
#include "tools/serve/state_folder.hpp"

namespace ipos::tools::serve {

OpenedPage::OpenedPage(const std::string& address) : name_(fmt::format("open-{}.html", getpid())) {
  const bool written = write_state(
      name_,
      fmt::format(
          "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n"
          "<meta http-equiv=\"refresh\" content=\"0; url={0}\">\n<a href=\"{0}\">ipos</a>\n",
          address));
  if (!written) {  // the address stands on standard output
    fmt::print(stderr,
               "ipos: --open: the file that leads a browser to the page cannot be written in the user's "
               "state folder ({}); open the address above\n",
               kStateVariable);
    return;
  }
  show_in_browser(state_folder() / name_);
}

OpenedPage::~OpenedPage() { remove_state(name_); }

}  // namespace ipos::tools::serve
