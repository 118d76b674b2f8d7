// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/geometry/placement.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <limits>
#include <map>

#include "io/base/error.h"
#include "io/base/machine.h"
#include "io/gltf/document/arrays.h"
#include "io/gltf/meshes/flat.h"

namespace petzval::io {
namespace {

bool fits_floats(const M44d& m) {
    constexpr double greatest = std::numeric_limits<float>::max();
    const double* const first = m.getValue();
    return std::all_of(first, first + 16, [](double x) { return std::fabs(x) <= greatest; });
}

class Grouping {
  public:
    Grouping(const GltfModel& gltf, const GltfNodes& nodes, const NodeMotion& motion,
             Places& places, GltfTally& tally)
        : gltf_(gltf),
          nodes_(nodes),
          motion_(motion),
          places_(places),
          tally_(tally),
          memory_(gltf.file) {}

    [[nodiscard]] std::vector<Placement> run() {
        for (const int index : nodes_.in_scene)
            if (nodes_.node[static_cast<size_t>(index)].mesh >= 0) add(index);
        return std::move(placements_);
    }

  private:
    void add(int index) {
        const GltfNode& node = nodes_.node[static_cast<size_t>(index)];
        const bool many = nodes_.instancing.contains(index);
        if (!fits_floats(places_.of_node(index)))
            throw InputError(gltf_.file, json_path("nodes", index),
                             "places its mesh beyond the range of a float");
        if (node.skin >= 0 && many)
            tally_.warnings.add(json_path("nodes", index),
                                "its skin places its mesh, so that its instances have no "
                                "meaning; it is shown once");
        const size_t places = node.skin >= 0 ? 1 : count(index, many);
        if (places == 0) return;
        const auto& mesh = gltf_.typed.meshes.at(static_cast<size_t>(node.mesh));
        const auto& weights = node.weights.empty() ? mesh.weights : node.weights;
        size_t at = placements_.size();
        const bool morphs = motion_.weights(index) != nullptr;
        if (node.skin < 0 && !morphs)
            at = known_.try_emplace({node.mesh, weights}, at).first->second;
        if (at == placements_.size()) placements_.push_back({node.mesh, node.skin, weights, {}});
        placements_[at].nodes.push_back(index);
        placements_[at].places += places;
        placements_[at].moves |= motion_.places(index) != nullptr;
        placements_[at].morphs |= morphs;
    }

    // Counts the places where the mesh shows, and what does not show.
    size_t count(int index, bool many) {
        if (many) memory_.ask(kInstanceBytes, places_.count(index), 1, json_path("nodes", index));
        size_t places = 0, hidden = 0;
        bool flattens = false;
        places_.each_with_own(index, [&](const M44d& in_the_middle, const M44d& own) {
            const M44d to_world = shown_place(motion_, index, in_the_middle, own);
            const bool shows = Places::shows(to_world);
            ++(shows ? places : hidden);
            flattens |= shows && is_singular(to_world);
        });
        if (flattens) tally_.honoured.insert("nodes that are flattened, as thin sheets");
        (many ? tally_.hidden_instances : tally_.singular_nodes) += hidden;
        return places;
    }

    const GltfModel& gltf_;
    const GltfNodes& nodes_;
    const NodeMotion& motion_;
    Places& places_;
    GltfTally& tally_;
    PlaceMemory memory_;
    std::vector<Placement> placements_;
    std::map<std::pair<int, std::vector<double>>, size_t> known_;
};

}  // namespace

PlaceMemory::PlaceMemory(const std::string& file)
    : file_(file), there_bytes_(static_cast<double>(usable_memory_bytes())) {}

void PlaceMemory::ask(double bytes, size_t places, size_t parts, const std::string& where,
                      size_t steps) {
    asked_bytes_ += bytes * static_cast<double>(places) * static_cast<double>(parts) *
                    static_cast<double>(steps);
    if (asked_bytes_ <= there_bytes_) return;
    const std::string moves = fmt::format("moves through {} time steps", steps);
    throw InputError(file_, where,
                     "{}: with what came before it takes {:.1f} GiB, and {:.1f} can be had; {}",
                     steps > 1 ? moves : fmt::format("stands at {} places", places),
                     asked_bytes_ * 0x1p-30, there_bytes_ * 0x1p-30,
                     steps > 1 ? "open the shutter for a shorter time" : "show fewer of them");
}

size_t Places::count(int node) {
    const auto many = nodes_.instancing.find(node);
    if (many == nodes_.instancing.end()) return 1;
    return accessor_of(gltf_, many->second.any()).count;
}

const InstancePlaces* Places::instances_of(int node) {
    const auto many = nodes_.instancing.find(node);
    if (many == nodes_.instancing.end()) return nullptr;
    if (read_node_ != node) read_.emplace(gltf_, many->second);
    read_node_ = node;
    return &*read_;
}

bool Places::shows(const M44d& to_world) {
    return fits_floats(to_world) && dimensions_left(to_world) >= 2;
}

M44d shown_place(const NodeMotion& motion, int node, const M44d& to_world, const M44d& own) {
    const auto* const places = Places::shows(to_world) ? nullptr : motion.places(node);
    if (!places) return to_world;
    M44d shown = to_world;
    double most = -1;
    for (const M44d& place : *places) {
        const M44d at = own * place;
        const double size = std::fabs(linear_part(at).determinant());
        if (!Places::shows(at) || size <= most) continue;
        most = size;
        shown = at;
    }
    return shown;
}

std::vector<Placement> find_placements(const GltfModel& gltf, const GltfNodes& nodes,
                                       const NodeMotion& motion, Places& places, GltfTally& tally) {
    return Grouping(gltf, nodes, motion, places, tally).run();
}

}  // namespace petzval::io
