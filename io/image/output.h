// SPDX-License-Identifier: Apache-2.0
// Output pictures of a command: format by file name, display view, never half a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"  // check_writable, for what is no picture
#include "io/file/rescue.h"
#include "io/image/display.h"
#include "io/picture/picture.h"

namespace petzval::io {

/// Display settings of PNG and JPEG; EXR is always scene-linear.
struct DisplayOptions {
    float exposure_ev = 0.f;
    std::string view = {};              ///< empty: the default one of the configuration
    std::filesystem::path config = {};  ///< of OpenColorIO; empty: Petzval's own
};

/// Checks early, before hours of work, that write_output() can do its work. Throws what it would
/// throw for this name, folder, view and size in pixels.
void check_output(const std::filesystem::path&, const DisplayOptions&, int width = 1,
                  int height = 1);

/// Writes a linear picture in the format that the path's ending names. Throws InputError.
void write_output(const std::filesystem::path&, const PictureRows& linear, const DisplayOptions&);

/// Name of an unfinished picture beside an output: NAME.partial.exr.
[[nodiscard]] std::filesystem::path partial_name(std::filesystem::path output);

/// Writes an unfinished picture to NAME.partial.exr beside each output NAME.*, once for each name,
/// or a copy of it somewhere else. Throws nothing itself.
[[nodiscard]] std::vector<WriteOutcome> write_partial(
    const std::vector<std::filesystem::path>& outputs, const PictureRows& linear);

}  // namespace petzval::io
