// SPDX-License-Identifier: Apache-2.0
// The lens that a subcommand of `petzval lens` is about.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "camera/lens/lens.h"
#include "io/file/overwrite.h"

namespace petzval::apps {

struct LensRequest {
    std::string lens;                   ///< name or file
    std::vector<std::string> catalogs;  ///< files of glasses
};
/// Adds the argument `lens` and --glasses.
void add_lens_request(CLI::App&, LensRequest&);

/// Refuses outputs that would destroy a file of the request, an input besides, or each other.
void refuse_overwriting(const std::vector<io::NamedFile>& outputs, const LensRequest&,
                        std::vector<io::NamedFile> inputs = {});

/// The lens, made ready; its file's warnings go to stderr.
[[nodiscard]] std::shared_ptr<const camera::Lens> open_lens(const LensRequest&);

void add_lens_table_commands(CLI::App& lens);     ///< list, show, check
void add_lens_trace_commands(CLI::App& lens);     ///< draw, trace
void add_lens_analysis_commands(CLI::App& lens);  ///< spot, fan, mtf, distortion, vignetting
void add_lens_wave_commands(CLI::App& lens);      ///< wavefront, psf
/// through-focus, field-curvature, focal-shift, lateral-colour
void add_lens_focus_commands(CLI::App& lens);
void add_lens_light_commands(CLI::App& lens);  ///< transmittance, budget, ghosts

}  // namespace petzval::apps
