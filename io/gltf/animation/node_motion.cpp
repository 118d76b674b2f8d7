// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/node_motion.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "io/gltf/meshes/matrix.h"

namespace petzval {
namespace {

using nlohmann::json;

constexpr size_t kMostSegments = 128;  // Embree takes 129 steps at most
constexpr double kMostBytes = 0x1p30;
/// Share of a body's extent that points may be off between time steps.
constexpr double kTolerance = 1e-3;

/// Keys of a property with the clip that has them.
struct Track {
    const Keyframes* keys = nullptr;
    const GltfClip* clip = nullptr;
    int element = -1;  ///< of a list; -1: the whole of it
};

struct Tracks {
    Track translation, rotation, scale;
    std::vector<Track> weights;

    [[nodiscard]] bool moves() const { return translation.keys || rotation.keys || scale.keys; }
};

/// Parts of "/nodes/3/weights/1": kind, index, name, element.
struct Target {
    std::string kind, name;
    int index = -1, element = -1;
};

std::optional<Target> target_in(const std::string& pointer) {
    const auto path = json::json_pointer(pointer);
    std::vector<std::string> words;
    for (auto at = path; !at.empty(); at.pop_back()) words.insert(words.begin(), at.back());
    if (words.size() < 3 || (words[0] != "nodes" && words[0] != "meshes")) return std::nullopt;
    const auto number = [](const std::string& text) {
        int value = -1;
        std::from_chars(text.data(), text.data() + text.size(), value);
        return value;
    };
    return Target{words[0], words[2], number(words[1]), words.size() > 3 ? number(words[3]) : -1};
}

std::vector<double> list(const json& owner, const char* key) {
    return owner.contains(key) ? owner[key].get<std::vector<double>>() : std::vector<double>();
}

template <size_t N>
void take(const json& node, const char* key, std::array<double, N>& to) {
    if (const auto values = list(node, key); values.size() == N)
        std::copy(values.begin(), values.end(), to.begin());
}

/// The tracks of a file, by what they move.
struct Collection {
    std::map<int, Tracks> of_nodes, of_meshes;

    explicit Collection(std::span<const GltfClip> clips) {
        for (const GltfClip& clip : clips)
            for (const AnimatedProperty& property : clip.properties) add(clip, property);
    }

    void add(const GltfClip& clip, const AnimatedProperty& property) {
        const auto target = target_in(property.pointer);
        if (!target) return;
        Tracks& tracks = (target->kind == "nodes" ? of_nodes : of_meshes)[target->index];
        const Track track{&property.keys, &clip, target->element};
        if (target->name == "translation") tracks.translation = track;
        if (target->name == "rotation") tracks.rotation = track;
        if (target->name == "scale") tracks.scale = track;
        if (target->name == "weights") tracks.weights.push_back(track);
    }

    /// Tracks that place a node; nullptr where it is not moved by itself.
    [[nodiscard]] const Tracks* placing(int node) const {
        const auto at = of_nodes.find(node);
        return at != of_nodes.end() && at->second.moves() ? &at->second : nullptr;
    }
    /// Tracks of the morph weights that a node shows: its own, else those of its mesh, where the
    /// node stores none that go before.
    [[nodiscard]] std::span<const Track> weighing(int index, const json& node) const {
        const auto own = of_nodes.find(index);
        if (own != of_nodes.end() && !own->second.weights.empty()) return own->second.weights;
        if (node.contains("weights")) return {};
        const auto of_mesh = of_meshes.find(node["mesh"].get<int>());
        return of_mesh == of_meshes.end() ? std::span<const Track>() : of_mesh->second.weights;
    }
};

/// The nodes of a file as a tree.
struct Tree {
    const json& nodes;
    std::vector<int> parent;  ///< -1: a root

    explicit Tree(const json& list_of_nodes)
        : nodes(list_of_nodes), parent(list_of_nodes.size(), -1) {
        for (size_t i = 0; i < nodes.size(); ++i)
            for (const double child : list(nodes[i], "children"))
                parent[static_cast<size_t>(child)] = static_cast<int>(i);
    }

    /// Nodes that tracks move, or that hang on one of these; each after its parent.
    [[nodiscard]] std::vector<int> moving(const Collection& tracks) const {
        std::vector<int> order, open;
        for (size_t i = 0; i < nodes.size(); ++i)
            if (parent[i] < 0) open.push_back(static_cast<int>(i));
        std::vector<bool> moves(nodes.size(), false);
        while (!open.empty()) {
            const int i = open.back();
            const auto index = static_cast<size_t>(i);
            open.pop_back();
            moves[index] = tracks.placing(i) != nullptr ||
                           (parent[index] >= 0 && moves[static_cast<size_t>(parent[index])]);
            if (moves[index]) order.push_back(i);
            for (const double child : list(nodes[index], "children"))
                open.push_back(static_cast<int>(child));
        }
        return order;
    }
};

NodePlace stored_place(const json& node) {
    NodePlace place;
    take(node, "translation", place.translation);
    take(node, "rotation", place.rotation);
    take(node, "scale", place.scale);
    return place;
}

M44d stored_matrix(const json& node) {
    M44d matrix = stored_place(node).matrix();
    if (const auto m = list(node, "matrix"); m.size() == 16)
        std::copy(m.begin(), m.end(), &matrix[0][0]);
    return matrix;
}

size_t segments_for(size_t moving_nodes) {
    size_t segments = kMostSegments;
    while (segments > 2 && double(segments) * double(moving_nodes) * sizeof(M44d) > kMostBytes)
        segments /= 2;
    return segments;
}

std::span<const double> numbers_of(const M44d& matrix) {
    return {matrix.getValue(), 16};
}
std::span<const double> numbers_of(const std::vector<double>& numbers) {
    return numbers;
}

// Whether numbers differ by more than rounding: a curve between equal keys rounds at every time
// otherwise.
bool differ(std::span<const double> a, std::span<const double> b) {
    constexpr double kRounding = 1e-12;
    double most = 0, apart = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, std::fabs(a[i]));
        apart = std::max(apart, std::fabs(a[i] - b[i]));
    }
    return apart > kRounding * most;
}

// Whether two keys lie within one time step, while the shutter is open. One alone shows in the
// steps around it, and so does a cubic spline that is several steps long.
bool has_keys_between_steps(const Track& track, const AnimationChoice& choice, double step_s) {
    const Keyframes& keys = *track.keys;
    const double least_s =
        keys.interpolation == Interpolation::CubicSpline ? 4 * step_s : 0.999 * step_s;
    const GltfClip& clip = *track.clip;
    const auto local_s = [&](double time_s) {
        return clip.local_s(time_s, choice.time_s, choice.repeats);
    };
    const double first_s = local_s(choice.time_s - choice.open_s / 2);
    const double last_s = local_s(choice.time_s + choice.open_s / 2);
    const bool wraps =
        choice.repeats && clip.closed && (last_s < first_s || choice.open_s >= clip.duration_s);
    for (size_t i = 1; i < keys.times_s.size(); ++i) {
        if (keys.times_s[i] - keys.times_s[i - 1] >= least_s) continue;
        if (keys.times_s[i] == keys.times_s[i - 1]) continue;
        if (!wraps && (keys.times_s[i] < first_s || keys.times_s[i - 1] > last_s)) continue;
        const auto a = keys.at(keys.times_s[i - 1]), b = keys.at(keys.times_s[i]);
        if (differ(a, b)) return true;
    }
    return false;
}

double most_second_difference(const std::vector<std::vector<V3d>>& at) {
    double most = 0;
    for (size_t i = 1; i + 1 < at.size(); ++i)
        for (size_t k = 0; k < at[i].size(); ++k)
            most = std::max(most, (at[i - 1][k] - at[i][k] * 2. + at[i + 1][k]).length());
    return most;
}

/// Coarsest stride at which off(step, before, after, share) stays within a bound.
template <class Off>
Thinning coarsest(size_t steps, double bound, Off off) {
    Thinning out;
    for (size_t stride = steps - 1; stride >= 1; stride /= 2) {
        double most = 0;
        for (size_t i = 0; i < steps; ++i) {
            const size_t before = std::min(i / stride * stride, steps - 1 - stride);
            most = std::max(most,
                            off(i, before, before + stride, double(i - before) / double(stride)));
            if (most > bound) break;
        }
        out.stride = stride;
        out.off_m = most;
        if (most <= bound) break;
    }
    return out;
}

}  // namespace

NodeMotion::NodeMotion(const json& posed, std::span<const GltfClip> clips,
                       const AnimationChoice& choice, std::span<const M44d> to_world) {
    if (!(choice.open_s > 0) || clips.empty() || !posed.contains("nodes")) return;
    const Collection tracks(clips);
    const Tree tree(posed["nodes"]);
    const std::vector<int> moving = tree.moving(tracks);
    steps_ = segments_for(moving.size()) + 1;
    const auto values_at = [&](const Track& track, size_t step) {
        const double share = double(step) / double(steps_ - 1) - 0.5;
        const double time_s = choice.time_s + share * choice.open_s;
        return track.keys->at(track.clip->local_s(time_s, choice.time_s, choice.repeats));
    };
    const double step_s = choice.open_s / double(steps_ - 1);
    const auto look_between_steps = [&](const Track& track) {
        if (track.keys && has_keys_between_steps(track, choice, step_s)) keys_between_steps_ = true;
    };
    const auto changes = [](const auto& all) {
        return std::any_of(all.begin(), all.end(), [&](const auto& one) {
            return differ(numbers_of(one), numbers_of(all[0]));
        });
    };

    for (const int i : moving) {
        const json& node = tree.nodes[static_cast<size_t>(i)];
        const int up = tree.parent[static_cast<size_t>(i)];
        const std::vector<M44d>* const above = up >= 0 ? places(up) : nullptr;
        const M44d still_above = up >= 0 ? to_world[static_cast<size_t>(up)] : M44d();
        const Tracks* const own = tracks.placing(i);
        NodePlace local = stored_place(node);
        M44d matrix = stored_matrix(node);
        std::vector<M44d> all(steps_);
        for (size_t step = 0; step < steps_; ++step) {
            const auto play = [&](const Track& track, auto& to) {
                if (!track.keys) return;
                const auto values = values_at(track, step);
                std::copy_n(values.begin(), to.size(), to.begin());
            };
            if (own) {
                play(own->translation, local.translation);
                play(own->rotation, local.rotation);
                play(own->scale, local.scale);
                matrix = local.matrix();
            }
            all[step] = matrix * (above ? (*above)[step] : still_above);
        }
        if (own)
            for (const Track& track : {own->translation, own->rotation, own->scale})
                look_between_steps(track);
        if (changes(all)) places_.emplace(i, std::move(all));
    }

    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        const json& node = tree.nodes[i];
        if (!node.contains("mesh")) continue;
        const auto played = tracks.weighing(static_cast<int>(i), node);
        if (played.empty()) continue;
        const json& mesh = posed["meshes"][node["mesh"].get<size_t>()];
        std::vector<std::vector<double>> all(
            steps_, list(node.contains("weights") ? node : mesh, "weights"));
        for (const Track& track : played) look_between_steps(track);
        for (size_t step = 0; step < steps_; ++step)
            for (const Track& track : played) {
                const auto values = values_at(track, step);
                const auto element = static_cast<size_t>(track.element);
                if (track.element < 0)
                    all[step] = values;
                else if (element < all[step].size())
                    all[step][element] = values[0];
            }
        if (changes(all)) weights_.emplace(static_cast<int>(i), std::move(all));
    }
}

const std::vector<M44d>* NodeMotion::places(int node) const {
    const auto at = places_.find(node);
    return at == places_.end() ? nullptr : &at->second;
}

const std::vector<std::vector<double>>* NodeMotion::weights(int node) const {
    const auto at = weights_.find(node);
    return at == weights_.end() ? nullptr : &at->second;
}

Thinning Thinning::operator|(const Thinning& o) const {
    return {std::min(stride, o.stride), std::max(off_m, o.off_m), std::max(size_m, o.size_m)};
}

Thinning thin(std::span<const M44d> to_world, std::span<const V3d> points) {
    std::vector<std::vector<V3d>> at(to_world.size());
    for (size_t i = 0; i < at.size(); ++i)
        for (const V3d& p : points) at[i].push_back(p * to_world[i]);
    Imath::Box<V3d> box;
    for (const V3d& p : at[at.size() / 2]) box.extendBy(p);
    const double size_m = box.isEmpty() ? 0 : box.size().length();
    Thinning out = coarsest(
        at.size(), kTolerance * size_m, [&](size_t i, size_t before, size_t after, double share) {
            double most = 0;
            for (size_t k = 0; k < points.size(); ++k)
                most = std::max(
                    most, (at[i][k] - at[before][k] * (1 - share) - at[after][k] * share).length());
            return most;
        });
    out.off_m += most_second_difference(at);
    out.size_m = size_m;
    return out;
}

Thinning thin(std::span<const std::vector<double>> weights, std::span<const double> sizes_m,
              double size_m) {
    const size_t count = std::min(sizes_m.size(), weights[0].size());
    const auto off = [&](size_t i, size_t before, size_t after, double share) {
        double sum = 0;
        for (size_t k = 0; k < count; ++k)
            sum += sizes_m[k] * std::fabs(weights[i][k] - weights[before][k] * (1 - share) -
                                          weights[after][k] * share);
        return sum;
    };
    Thinning out = coarsest(weights.size(), kTolerance * size_m, off);
    double bend = 0;
    for (size_t i = 1; i + 1 < weights.size(); ++i)
        bend = std::max(bend, 2 * off(i, i - 1, i + 1, 0.5));
    out.off_m += bend;
    out.size_m = size_m;
    return out;
}

}  // namespace petzval
