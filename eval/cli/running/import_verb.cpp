#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/reading_options.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/record/clock_note.hpp"
#include "eval/run/foreign_runs.hpp"
#include "eval/suites/recording_names.hpp"

namespace fusebench::cli::running {

namespace {

struct ImportOptions {
  std::string name;
  std::filesystem::path trajectory;
  std::filesystem::path mesh;
  std::string trajectory_format;
  std::string unit = "m";
  std::string pose = "camera_to_world";
  std::string poses = "final";
  std::string recording;
  std::filesystem::path data;
  std::filesystem::path out;
  console::ReadingOptions reading;
  std::string frames;
  std::string imu;
  int threads = 1;
};

Result<run::ImportSpec> spec_of(const ImportOptions& options) {
  run::ImportSpec spec;
  spec.name = options.name;
  spec.trajectory.file = options.trajectory;
  spec.trajectory.unit_m = options.unit == "mm" ? 1e-3 : 1;
  spec.trajectory.world_to_camera = options.pose == "world_to_camera";
  spec.trajectory.online = options.poses == "online";
  spec.mesh = options.mesh;
  spec.mesh_unit_m = spec.trajectory.unit_m;
  if (!options.trajectory_format.empty()) {
    const auto format = trajectory_files::parse_trajectory_format(options.trajectory_format);
    if (!format) return tl::unexpected(format.error());
    spec.trajectory.format = *format;
  }
  const auto folder = suites::find_recording(options.recording, options.data);
  if (!folder) return tl::unexpected(folder.error());
  spec.recording = *folder;
  auto how = console::open_options(options.reading);
  if (!how) return tl::unexpected(how.error());
  spec.open = std::move(*how);
  const auto window = console::parse_frames(options.frames);
  if (!window) return tl::unexpected(window.error());
  spec.frames = *window;
  if (!options.imu.empty()) spec.imu = options.imu == "synthetic" ? "synthetic IMU" : options.imu;
  spec.threads = options.threads;
  spec.out = options.out;
  return spec;
}

Result<int> import(const ImportOptions& options) {
  const auto spec = spec_of(options);
  if (!spec) return tl::unexpected(spec.error());
  const auto run = run::import_run(*spec);
  if (!run) return tl::unexpected(run.error());
  console::print_warnings(run->warnings);
  console::print_progress(fmt::format("{}: {}", run->record.variant, console::summary_line(run->record)));
  if (const auto note = record::clock_note(run->record))
    console::print_progress(fmt::format("{}: {}", run->record.variant, *note));
  console::print_output(run->folder.string() + "\n");
  return 0;
}

}  // namespace

console::Verb add_import_verb(CLI::App& app) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* verb = app.add_subcommand(
      "import",
      "Imports another system's trajectory and mesh as a run, evaluated like the runs of this program");
  verb->add_option("NAME", options->name, "The other system: the run's variant in tables and reports")
      ->required();
  verb->add_option("TRAJECTORY", options->trajectory,
                   "Its poses of the colour camera (--trajectory-format), or NAME.sens")
      ->required();
  verb->add_option("MESH", options->mesh, "Mesh of the system in the frame of these poses, .ply or .obj");
  verb->add_option("--recording", options->recording,
                   "Folder of the recording, or the name of one under --data")
      ->type_name("REC")
      ->required();
  verb->add_option("--out", options->out, "Folder of results, as of `run` and `bench`")
      ->type_name("DIR")
      ->required();
  verb->add_option("--trajectory-format", options->trajectory_format,
                   "tum, kitti, euroc, log or openvins; recognised if not given, as is NAME.sens")
      ->type_name("NAME");
  verb->add_option("--unit", options->unit, "Unit of its positions and of its mesh")
      ->check(CLI::IsMember({"m", "mm"}))
      ->capture_default_str();
  verb->add_option("--pose", options->pose, "Direction of its poses: camera to world, or the inverse")
      ->check(CLI::IsMember({"camera_to_world", "world_to_camera"}))
      ->capture_default_str();
  verb->add_option("--poses", options->poses,
                   "online: estimated when the frame arrived; final: estimated at the end. A label in tables")
      ->check(CLI::IsMember({"online", "final"}))
      ->capture_default_str();
  verb->add_option("--imu", options->imu,
                   "Inertial data that it used: none, recorded or synthetic; labels its rows in tables")
      ->check(CLI::IsMember({"none", "recorded", "synthetic"}));
  verb->add_option("--frames", options->frames, "It was given only frames A to B-1")->type_name("A:B");
  console::add_reading_options(*verb, options->reading);
  console::add_threads_option(*verb, options->threads);
  console::add_data_option(*verb, options->data);
  verb->footer("Prints the run's folder. Frames without a pose within 0.02 s count as lost.");
  return {verb, [options] { return import(*options); }};
}

}  // namespace fusebench::cli::running
