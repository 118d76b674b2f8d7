// SPDX-License-Identifier: Apache-2.0
// Phases of a render, for those who watch it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

namespace petzval::apps {

/// Loading: files are read. Bvh: the search trees of triangles and lights are built. Planning: the
/// camera is focused, and what the user left open is chosen. Denoising: only where it is asked for.
enum class Phase : uint8_t { Loading, Bvh, Planning, Rendering, Denoising, Writing, Count };

/// Names in progress lines and statistics.
inline constexpr std::array<const char*, static_cast<size_t>(Phase::Count)> kPhaseNames{
    "loading", "bvh", "planning", "rendering", "denoising", "writing"};

/// Receives each phase when it begins, and Planning before each task of it, from any thread.
using PhaseSink = std::function<void(Phase)>;

}  // namespace petzval::apps
