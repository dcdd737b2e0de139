// `--open`: a browser at the page. Arguments of a program can be read by every user of the computer, and the address
// has the token in it. So the browser is given a file that leads to the address, and that only this user can read.
#pragma once

#include <string>

namespace ipos::tools::serve {

class OpenedPage {
 public:
  // Tells on standard error where there is no place for the file.
  explicit OpenedPage(const std::string& address);
  // The browser stays; the file goes.
  ~OpenedPage();
  OpenedPage(const OpenedPage&) = delete;
  OpenedPage& operator=(const OpenedPage&) = delete;

 private:
  std::string name_;
};

}  // namespace ipos::tools::serve
