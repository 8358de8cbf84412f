#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/base/printable.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/text/markup_text.hpp"

namespace fusebench::compare {

namespace {

/// As an attribute or text of XML 1.0, which takes no control characters at all.
std::string xml_escaped(std::string_view text) {
  return text::with_entities(printable(text, std::numeric_limits<std::size_t>::max()), "&<>\"'");
}

std::string test_case(const ComparedRun& run, const GateResult& gate) {
  const std::string message = xml_escaped(gate.message);
  std::string inside;
  if (gate.fails) {
    inside = fmt::format("<failure type=\"{}\" message=\"{}\"/>", to_string(gate.verdict), message);
  } else if (!gate.not_gated.empty()) {
    inside = fmt::format("<skipped message=\"{}\"/>", message);
  } else if (!message.empty()) {
    inside = fmt::format("<system-out>{}: {}</system-out>", to_string(gate.verdict), message);
  }
  return fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\">{}</testcase>\n",
                     xml_escaped(run.runs.label), xml_escaped(gate.gate), inside);
}

struct Counts {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t skipped = 0;
};

Counts counts_of(const ComparedRun& run) {
  Counts counts{run.gates.size(), 0, 0};
  for (const GateResult& gate : run.gates) {
    if (gate.fails) ++counts.failures;
    if (!gate.fails && !gate.not_gated.empty()) ++counts.skipped;
  }
  return counts;
}

std::string counts_text(const Counts& counts) {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"0\"", counts.tests,
                     counts.failures, counts.skipped);
}

}  // namespace

std::string comparison_junit(const RunComparison& comparison) {
  Counts all;
  std::string suites;
  for (const ComparedRun& run : comparison.runs) {
    const Counts counts = counts_of(run);
    all.tests += counts.tests;
    all.failures += counts.failures;
    all.skipped += counts.skipped;
    suites += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_escaped(run.runs.label), counts_text(counts));
    for (const GateResult& gate : run.gates) suites += test_case(run, gate);
    suites += "  </testsuite>\n";
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fusebench compare\" "
      "{}>\n{}</testsuites>\n",
      counts_text(all), suites);
}

}  // namespace fusebench::compare
