#include "tests/layering/type_names.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

namespace planetree::layering {
namespace {

using Tokens = std::vector<std::string>;

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Splits a source into names, "::" and other characters. Leaves out comments, directives, texts,
/// numbers and attributes.
class Tokenizer {
 public:
  explicit Tokenizer(std::string_view text) : text_(text) {}

  Tokens split() {
    while (at_ < text_.size()) {
      const std::size_t begin = at_;
      if (skip("//", "\n") || skip("/*", "*/") || skip("R\"(", ")\"") || skip("[[", "]]") ||
          skip_directive() || skip_quoted())
        continue;
      if (is_of_word(text_[at_])) {
        const bool is_number = std::isdigit(static_cast<unsigned char>(text_[at_])) != 0;
        while (at_ < text_.size() &&
               (is_of_word(text_[at_]) || (is_number && (text_[at_] == '\'' || text_[at_] == '.'))))
          ++at_;
        if (is_number) continue;
      } else {
        at_ += text_.substr(at_).starts_with("::") ? 2 : 1;
      }
      const std::string_view token = text_.substr(begin, at_ - begin);
      if (std::isspace(static_cast<unsigned char>(token[0])) == 0) tokens_.emplace_back(token);
    }
    return std::move(tokens_);
  }

 private:
  bool skip(std::string_view begin, std::string_view end) {
    if (!text_.substr(at_).starts_with(begin)) return false;
    const std::size_t found = text_.find(end, at_ + begin.size());
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
    return true;
  }
  bool skip_directive() {
    if (text_[at_] != '#') return false;
    while (at_ < text_.size() && (text_[at_] != '\n' || text_[at_ - 1] == '\\')) ++at_;
    return true;
  }
  bool skip_quoted() {
    const char quote = text_[at_];
    if (quote != '"' && quote != '\'') return false;
    for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_)
      if (text_[at_] == '\\') ++at_;
    ++at_;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Tokens tokens_;
};

bool is_one_of(const std::string& token, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, token) != words.end();
}

/// Goes through the scopes of a source.
class TypeFinder {
 public:
  explicit TypeFinder(std::string_view text) : tokens_(Tokenizer(text).split()) {}

  std::vector<std::string> find() {
    while (at_ < tokens_.size()) {
      const std::string& token = tokens_[at_++];
      if (token == "namespace") {
        enter_namespace();
      } else if (depth_ == 0 && is_one_of(token, {"class", "struct", "union", "enum"})) {
        take_type();
      } else if (token == "{") {
        ++depth_;
      } else if (token == "}" && depth_ > 0) {
        --depth_;
      } else if (token == "}" && !namespaces_.empty()) {
        namespaces_.pop_back();
      }
    }
    return std::move(types_);
  }

 private:
  bool is_at(std::initializer_list<std::string_view> words) const {
    return at_ < tokens_.size() && is_one_of(tokens_[at_], words);
  }
  /// Joins the tokens up to one of these, which is not passed.
  std::string take_until(std::initializer_list<std::string_view> ends) {
    std::string joined;
    for (; at_ < tokens_.size() && !is_at(ends); ++at_) joined += tokens_[at_];
    return joined;
  }

  /// Behind "namespace". A namespace alias and "using namespace" have no body.
  void enter_namespace() {
    const std::string name = take_until({"{", ";", "="});
    if (!is_at({"{"})) return;
    namespaces_.push_back(name);
    ++at_;
  }

  /// Behind "class" and the like. The name is the last one in front of bases or body: a macro may
  /// precede it.
  void take_type() {
    std::string name;
    for (; !is_at({"{", ";", ":", "<", ">", "(", ")", ",", "=", "&", "*"}); ++at_) {
      if (at_ == tokens_.size()) return;
      if (is_at({"final", "class", "struct"})) continue;
      if (is_at({"alignas"})) {
        take_until({")"});
        continue;
      }
      const bool continues = is_at({"::"}) || name.ends_with("::");
      name = continues ? name + tokens_[at_] : tokens_[at_];
    }
    const bool is_type = is_at({"{", ":"});
    if (is_at({":"})) take_until({"{", ";"});
    const bool is_anonymous = std::ranges::find(namespaces_, "") != namespaces_.end();
    if (!is_type || !is_at({"{"}) || is_anonymous || name.empty()) return;
    std::string scope;
    for (const std::string& each : namespaces_) scope += each + "::";
    types_.push_back(scope + name);
  }

  Tokens tokens_;
  std::size_t at_ = 0;
  std::vector<std::string> namespaces_;  // around the token; empty: an anonymous one
  std::size_t depth_ = 0;                // braces within the innermost namespace
  std::vector<std::string> types_;
};

}  // namespace

std::vector<std::string> types_with_bodies(std::string_view text) {
  return TypeFinder(text).find();
}

std::vector<std::string> types_in_several(const std::vector<SourceText>& sources) {
  std::map<std::string, std::set<std::string>> paths;
  for (const SourceText& source : sources)
    for (const std::string& type : types_with_bodies(source.text)) paths[type].insert(source.path);
  std::vector<std::string> found;
  for (const auto& [type, where] : paths) {
    if (where.size() < 2) continue;
    std::string line = type + " has a body in";
    for (const std::string& path : where) line += ' ' + path;
    found.push_back(line);
  }
  return found;
}

}  // namespace planetree::layering
