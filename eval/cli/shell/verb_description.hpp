// The verbs and options of the program as data, read from its parser, for manual pages and completions.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fusebench::cli::shell {

/// The completion of a value.
enum class ValueKind {
  none,  ///< a flag takes no value
  words,
  file,
  folder,
  text,  ///< anything: nothing is proposed
};

struct OptionDescription {
  std::vector<std::string> flags;  ///< "-o", "--out"; empty for positionals
  std::string name;                ///< "-o,--out" or "RECORDING", as help texts have it
  std::string value;               ///< what follows the name in help texts: "DIR=results/runs"
  std::string sentence;
  std::string group;  ///< its heading in help texts
  ValueKind kind = ValueKind::none;
  std::vector<std::string>
      words;             ///< of ValueKind::words; one that ends with '=' is the beginning of a value
  bool repeats = false;  ///< any number of values
};

/// Hidden verbs and options are left out.
struct VerbDescription {
  std::vector<std::string> path;  ///< {"eval", "ate"}; empty of the program
  std::string other_name;         ///< that the last word may have: "ape"; mostly empty
  std::string sentence;
  std::string usage;  ///< "fusebench eval ate [OPTIONS] GT EST"
  std::string footer;
  std::vector<OptionDescription> places;  ///< positionals in their order
  std::vector<OptionDescription> options;
  std::vector<VerbDescription> verbs;
};

/// Of a program with its verbs.
[[nodiscard]] VerbDescription describe_verbs(const CLI::App& program);

}  // namespace fusebench::cli::shell
