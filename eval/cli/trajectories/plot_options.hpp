// evo's options of plots. There are no windows: a plot is a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/trajectories/transcript.hpp"
#include "eval/report/metric_reports/plot_parts.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::trajectories {

struct PlotOptions {
  std::string usual_file;  ///< of -p, which names none
  bool plot = false;
  std::filesystem::path plot_to;
  std::filesystem::path save_plot;

  [[nodiscard]] bool asked() const { return plot || !plot_to.empty() || !save_plot.empty(); }
};

/// -p, --plot FILE and --save_plot FILE; usual_file, like "ape.svg", is set before.
void add_plot_options(CLI::App& verb, PlotOptions& options);
/// --plot_mode.
void add_plot_mode_option(CLI::App& verb, std::string& mode);

/// The files that are to be drawn, none or more. Error usage: an ending that none is drawn as.
[[nodiscard]] Result<std::vector<metric_reports::PlotFile>> plot_files(const PlotOptions& options);

/// Error usage: a file of --save_table whose name does not end with .csv. An empty name is allowed.
[[nodiscard]] Result<void> check_table_file(const std::filesystem::path& file);

/// Draws script_of(file) into each and notes it. Errors as draw().
template <typename ScriptOf>
Result<void> draw_all(const std::vector<metric_reports::PlotFile>& files, Transcript& transcript,
                      const ScriptOf& script_of) {
  for (const metric_reports::PlotFile& file : files) {
    if (auto drawn = metric_reports::draw(script_of(file), file); !drawn) return drawn;
    const auto path = (file.folder / page::figure_file(file.name, file.format)).lexically_normal();
    transcript.note(path.string() + ": drawn");
  }
  return {};
}

}  // namespace fusebench::cli::trajectories
