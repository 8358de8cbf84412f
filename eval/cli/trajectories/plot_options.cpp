#include "eval/cli/trajectories/plot_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace fusebench::cli::trajectories {

void add_plot_options(CLI::App& verb, PlotOptions& options) {
  verb.add_flag("-p", options.plot,
                fmt::format("Draws the plots into {} (evo opens a window)", options.usual_file));
  verb.add_option("--plot", options.plot_to, "Draws the plots into FILE.svg or FILE.pdf; without FILE as -p")
      ->type_name("[FILE]");
  verb.add_option("--save_plot", options.save_plot, "The same, always with FILE")->type_name("FILE");
}

void add_plot_mode_option(CLI::App& verb, std::string& mode) {
  std::vector<std::string> names(metric_reports::kPlotModes.begin(), metric_reports::kPlotModes.end());
  verb.add_option("--plot_mode", mode, "Axes of the view in plots: xy, xz, yx, yz, zx, zy or xyz")
      ->type_name("AXES")
      ->check(CLI::IsMember(std::move(names)))
      ->capture_default_str();
}

Result<std::vector<metric_reports::PlotFile>> plot_files(const PlotOptions& options) {
  std::vector<metric_reports::PlotFile> files;
  // -p with --save_plot shows and saves the same.
  const bool usual = options.plot && options.plot_to.empty() && options.save_plot.empty();
  for (const std::filesystem::path& path :
       {usual ? std::filesystem::path(options.usual_file) : std::filesystem::path(), options.plot_to,
        options.save_plot}) {
    if (path.empty()) continue;
    auto file = metric_reports::plot_file(path);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
  }
  return files;
}

Result<void> check_table_file(const std::filesystem::path& file) {
  if (file.empty() || file.extension() == ".csv") return {};
  return fail(ErrorCode::usage,
              fmt::format("--save_table {}: only CSV is written (allowed: FILE.csv)", file.string()),
              "`fusebench table RUNS --format latex` writes the table of a folder of runs for LaTeX");
}

}  // namespace fusebench::cli::trajectories
