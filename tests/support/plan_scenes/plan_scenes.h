// SPDX-License-Identifier: Apache-2.0
// Scenes made of random numbers to fool petzval plan: what matters lies in few pixels, or is rare.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/request/scene_request.h"
#include "core/film/film.h"

namespace petzval::test {

/// A scene, how it is seen, and where a simpler model may differ.
struct PlanScene {
    std::string kind;            ///< its name
    bool decoy = false;          ///< of its kind, but simpler models are as good, or nearly
    std::string gltf;            ///< text of the file
    apps::SceneRequest request;  ///< without the path of the scene
    double tolerance = 0.01;
    /// Pixels outside show the same through all models. They may overlap.
    std::vector<Rect> matters;

    /// Writes the file, and returns the request for it.
    [[nodiscard]] apps::SceneRequest save(const std::filesystem::path& folder) const;
    /// Command-line options of petzval that show the same, but for the path of the scene.
    [[nodiscard]] std::string options() const;
};

inline constexpr uint32_t kPlanSceneKinds = 8;

/// Scene of an index: the same on every machine. Kinds take turns.
[[nodiscard]] PlanScene plan_scene(uint32_t index);

}  // namespace petzval::test
