// SPDX-License-Identifier: Apache-2.0
// Names of files that a render writes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/request/render_order.h"

namespace petzval::apps {

/// Complaint about the name of a picture to write; empty where it is right. As the functions below.
[[nodiscard]] std::string complaint_about_picture_name(const std::string&);
/// Complaint about the name of a picture, or of a state, to write.
[[nodiscard]] std::string complaint_about_render_name(const std::string&);
/// Complaint about the name of a picture to write for a display: no EXR.
[[nodiscard]] std::string complaint_about_display_name(const std::string&);

/// Whether a file's name is that of a state.
[[nodiscard]] bool is_state_name(const std::filesystem::path&);
/// Whether a picture of this name is for a display: any but an EXR.
[[nodiscard]] bool is_for_display(const std::filesystem::path&);

/// Files of a render, told apart.
struct RenderFiles {
    std::vector<std::filesystem::path> pictures;
    std::optional<std::filesystem::path> state;  ///< absent: none is written
    bool state_stays = false;                    ///< when the render is complete
};

/// Files of an order. The state is one of its outputs, or lies beside the first picture. Throws
/// ValueError.
[[nodiscard]] RenderFiles files_of(const RenderOrder&);

/// Name of a frame's file: the last run of # becomes the number, with zeros up to its length.
/// Throws ValueError where there is no # but several frames.
[[nodiscard]] std::filesystem::path name_of_frame(const std::string& option,
                                                  const std::filesystem::path&, int frame,
                                                  bool several);

/// Puts the number of a picture into the names of its files. Throws ValueError where `several`
/// pictures would share a name.
void number_files(RunRequest&, int number, bool several);

/// Time between two checkpoints of a state of that size: as asked, or ten minutes for a state that
/// stays anyway or is small enough; nothing where there is none.
[[nodiscard]] std::optional<double> checkpoint_interval_s(const Checkpoint&, const RenderFiles&,
                                                          uint64_t state_bytes);

}  // namespace petzval::apps
