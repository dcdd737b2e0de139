// Where the formatter breaks lines and how far it indents them. Works on words, not on the tree: macros and
// conditions may hold any part of a program.
#pragma once

#include <string>
#include <vector>

#include "compiler/format/pieces.hpp"

namespace ipos::compiler {

struct Line {
  uint32_t indent = 0;  // levels
  std::string code;     // words, or a comment that has its line to itself
  std::string comment;  // after the code
  bool blank_before = false;
  bool verbatim = false;  // a preprocessor line
};

class Layout {
 public:
  explicit Layout(const std::vector<Piece>& pieces) : pieces_(pieces) {}
  tl::expected<std::vector<Line>, FormatError> run();

 private:
  // Something that the next statement is inside of: braces, or the head of a statement that waits for its
  // body. IfDone waits for an else, DoTail for the while after its body.
  struct Frame {
    enum class Kind : uint8_t { Braces, If, IfDone, For, Plain, Do, DoTail };
    Kind kind;
    uint32_t indent;      // of the head or of the brace
    bool labels = false;  // a case stood in these braces
    bool record = false;  // braces of a typedef struct: a name follows them
  };
  // All that a preprocessor condition has to put back for its next branch.
  struct State {
    std::vector<Frame> frames;
    uint32_t indent = 0;   // of the statement under way
    size_t brackets = 0;   // open ( and [
    size_t questions = 0;  // ? without their :
    bool start = true;     // a statement begins
    bool body = false;     // and it is the body of the top frame
    bool head = false;     // inside the brackets after if, for, while, switch
    bool label = false;    // between case and its :
    bool record = false;   // the statement began with typedef
  };
  struct Last {
    TokenKind kind = TokenKind::Semicolon;
    std::string_view text;
    bool prefix = false;  // an operator with its operand after it
  };

  bool token(const Piece& piece);
  void open_brace(const Piece& piece);
  void close_brace(const Piece& piece);
  void statement_start(const Piece& piece);
  void behind(const Piece& piece);
  void finish_statement();
  void directive(const Piece& piece);

  uint32_t content_indent() const;
  bool fresh(const Piece& piece) const;
  TokenKind next_token() const;

  void place(const Piece& piece, bool new_line, uint32_t indent);
  void place_comments(bool new_line, uint32_t indent);
  void start_line(uint32_t indent, std::string code, const Piece& piece, bool blank_allowed);
  bool spaced(const Piece& piece, bool prefix) const;

  const std::vector<Piece>& pieces_;
  size_t at_ = 0;
  std::vector<const Piece*> comments_;  // not placed yet
  std::vector<Line> lines_;
  State state_;
  Last last_;
  // At each open #if.
  struct Condition {
    State state;
    Last last;
  };
  std::vector<Condition> conditions_;
};

}  // namespace ipos::compiler
