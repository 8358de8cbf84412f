#include "eval/cli/recordings/calibration_output.hpp"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "core/base/printable.hpp"
#include "eval/cli/console/console.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::cli::recordings {

Result<void> write_calibration(const std::filesystem::path& out, const calibration::RigCalibration& rig) {
  if (out.empty()) return {};
  std::error_code ignored;
  const bool there = std::filesystem::exists(out, ignored);
  const auto replaced = calibration::read_calibration(out);
  const std::string toml = calibration::to_toml(rig);
  if (auto readable = calibration::check_readable(toml, out.string()); !readable) return readable;
  if (auto written = text::write_text_file(out, toml); !written) return written;
  std::string before;
  if (replaced)
    before = fmt::format(", in place of a calibration ({})",
                         replaced->source.empty() ? "no source given" : printable(replaced->source, 200));
  else if (there)
    before = ", in place of another file";
  console::print_progress(fmt::format("{}: written{}", out.string(), before));
  return {};
}

}  // namespace fusebench::cli::recordings
