// The folder of a run: its files and, last of all, its record.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/io/staged_folder.hpp"
#include "core/base/types.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run {

/// A file of a run's folder by its name.
using NamedText = std::pair<std::string_view, std::string>;

/// Writes mesh.ply (nullptr: none; with errors of its vertices if there is a ground-truth mesh), the texts
/// that are not empty, and the record, and commits the folder. The record gets the sizes and hashes of the
/// files. Error io.
[[nodiscard]] Result<void> write_run_folder(io::StagedFolder& folder, Mesh* mesh,
                                            std::span<const NamedText> texts, record::RunRecord& record);

}  // namespace fusebench::run
