// SPDX-License-Identifier: Apache-2.0
#include "io/image/output.h"

#include <algorithm>

#include "io/base/atomic_file.h"

namespace petzval {

void check_output(const std::filesystem::path& path, const DisplayOptions& display) {
    if (picture_format(path) != PictureFormat::Exr)
        static_cast<void>(find_view(display.view, display.config));
    check_writable(path);
}

void write_output(const std::filesystem::path& path, const PictureRows& linear,
                  const DisplayOptions& display) {
    const PictureFormat format = picture_format(path);
    if (format == PictureFormat::Exr) return write_exr(path, linear);
    const AlphaUse use = format == PictureFormat::Png ? AlphaUse::Keep : AlphaUse::OnBlack;
    // What display a view of another configuration is for is not known.
    write_8bit(path, to_display(linear, display.exposure_ev, display.view, use, display.config),
               display.config.empty());
}

std::vector<std::filesystem::path> write_partial(const std::vector<std::filesystem::path>& outputs,
                                                 const PictureRows& linear) {
    std::vector<std::filesystem::path> written;
    for (std::filesystem::path path : outputs) {
        path.replace_extension(".partial.exr");
        if (std::find(written.begin(), written.end(), path) != written.end()) continue;
        write_exr(path, linear);
        written.push_back(path);
    }
    return written;
}

}  // namespace petzval
