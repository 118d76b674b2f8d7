// SPDX-License-Identifier: Apache-2.0
// A lens on the bench, for a page: its section with rays, and its figures at a point of the field.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace petzval::apps {

struct BenchRequest {
    std::string lens;      ///< text of a lens file in our JSON
    double height_mm = 0;  ///< of the field point on the film, from its middle, in the y-z section
    double focus_m = 0;    ///< from the entrance pupil; 0: a distant object
    double fstop = 0;      ///< 0: wide open
};

/// {"elements", "faces", "stop", "film": the section, mm; "rays": of F, d, C; "spots": mm on the
/// film, "middle_mm": theirs; "fans": um; "mtf"; "figures": [name, text]}. Throws InputError where
/// the lens is not as it must be or passes no light there.
[[nodiscard]] nlohmann::json bench_facts(const BenchRequest&);

}  // namespace petzval::apps
