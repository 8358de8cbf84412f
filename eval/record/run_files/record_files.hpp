// The files of a run's folder: what its record says of them, and whether they are still that.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/staged_folder.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run_files {

/// Puts sizes and hashes of the files of a folder that is still being written into the record, writes the
/// record as the last of them, and commits the folder. frames.csv, trace.json and `varying` (a name; may be
/// empty) differ between repetitions: they stand below `timing`. Error io.
[[nodiscard]] Result<void> commit_run(io::StagedFolder& folder, record::RunRecord& record,
                                      std::string_view varying = {});

/// What a row says of a damaged file of a run: "mesh.ply is damaged: 0 bytes of 1024; run it again".
[[nodiscard]] std::string damage_text(std::string_view file, std::string_view problem);

/// damage_text() of the first of these files whose size is another one; empty if there is none. A file that
/// is not there was taken away by somebody, which is no damage.
[[nodiscard]] std::string changed_size(const std::filesystem::path& run,
                                       std::span<const record::RecordedFile> files);
[[nodiscard]] std::string changed_size(const std::filesystem::path& run, const record::RunRecord& record);

/// Names of the recorded files that are not there.
[[nodiscard]] std::vector<std::string> missing_files(const std::filesystem::path& run,
                                                     const record::RunRecord& record);

/// That a file which is to be read is the one that was written; nothing is known of the files of older
/// records. Errors: data_corrupt with damage_text(); those of Fingerprint::add_file() for one that is not
/// there.
[[nodiscard]] Result<void> check_file(const std::filesystem::path& run, const record::RunRecord& record,
                                      std::string_view name);

/// check_file() of all that are there.
[[nodiscard]] Result<void> check_files(const std::filesystem::path& run, const record::RunRecord& record);

}  // namespace fusebench::run_files
