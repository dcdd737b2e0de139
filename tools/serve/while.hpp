// A flag that is set as long as something goes on.
#pragma once

namespace ipos::tools::serve {

class While {
 public:
  explicit While(bool& flag) : flag_(flag) { flag_ = true; }
  ~While() { flag_ = false; }
  While(const While&) = delete;
  While& operator=(const While&) = delete;

 private:
  bool& flag_;
};

}  // namespace ipos::tools::serve
