// What the scripts of a page draw, as the JSON that they read.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "eval/page/page.hpp"

namespace fusebench::page {

using Json = nlohmann::ordered_json;

/// part: the place of the part of the page that it stands in.
[[nodiscard]] Json json_of(const Chart& chart, std::size_t part);
[[nodiscard]] Json json_of(const PageScene& scene, std::size_t part);

}  // namespace fusebench::page
