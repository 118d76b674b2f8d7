// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/node_motion.h"

#include <algorithm>
#include <charconv>
#include <numbers>

#include "io/base/json_parse.h"
#include "io/gltf/animation/node_place.h"
#include "io/gltf/animation/pose.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr size_t kMostSegments = 128;  // Embree takes 129 steps at most
constexpr double kMostBytes = 0x1p30;

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

int number_in(std::string_view word) {
    int value = -1;
    std::from_chars(word.data(), word.data() + word.size(), value);
    return value;
}

std::vector<double> list(const json& owner, const char* key) {
    const json& numbers = member(owner, key);
    return numbers.is_array() ? numbers.get<std::vector<double>>() : std::vector<double>();
}

/// Value of a key; nullptr where there is none.
template <class Map>
const typename Map::mapped_type* found_in(const Map& map, const typename Map::key_type& key) {
    const auto at = map.find(key);
    return at == map.end() ? nullptr : &at->second;
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

template <class All>
bool changes(const All& all) {
    return std::any_of(all.begin(), all.end(), [&](const auto& one) {
        return differ(numbers_of(one), numbers_of(all[0]));
    });
}

/// Time within a clip at a share of the exposure, from -0.5 as the shutter opens to 0.5.
double local_s(const GltfClip& clip, const AnimationChoice& choice, double share) {
    return clip.local_s(choice.time_s + share * choice.open_s, choice.time_s, choice.repeats);
}

/// The part of a clip that is played while the shutter is open.
struct Reach {
    double first_s, last_s;
    bool wraps;  ///< over the end of the clip, so that all of it may be met

    Reach(const GltfClip& clip, const AnimationChoice& choice)
        : first_s(local_s(clip, choice, -0.5)), last_s(local_s(clip, choice, 0.5)) {
        wraps =
            choice.repeats && clip.closed && (last_s < first_s || choice.open_s >= clip.duration_s);
    }
    [[nodiscard]] bool meets(double from_s, double to_s) const {
        return wraps || (to_s >= first_s && from_s <= last_s);
    }
};

// Whether two keys lie within one time step, while the shutter is open. One alone shows in the
// steps around it, and so does a cubic spline that is several steps long.
bool has_keys_between_steps(const Track& track, const AnimationChoice& choice, double step_s) {
    const Keyframes& keys = *track.keys;
    const double least_s =
        keys.interpolation == Interpolation::CubicSpline ? 4 * step_s : 0.999 * step_s;
    const Reach reach(*track.clip, choice);
    for (size_t i = 1; i < keys.times_s.size(); ++i) {
        if (keys.times_s[i] - keys.times_s[i - 1] >= least_s) continue;
        if (keys.times_s[i] == keys.times_s[i - 1]) continue;
        if (!reach.meets(keys.times_s[i - 1], keys.times_s[i])) continue;
        const auto a = keys.at(keys.times_s[i - 1]), b = keys.at(keys.times_s[i]);
        if (differ(a, b)) return true;
    }
    return false;
}

// What a property is of; empty for what moves, or shows in no picture.
std::string what_holds(const std::string& pointer) {
    const auto words = words_of(pointer);
    const auto has = [&](std::string_view word) { return std::ranges::count(words, word) > 0; };
    if (has("KHR_texture_transform")) return "textures";
    if (words[0] == "materials") return words.back() == "strength" ? "" : "materials";
    if (has("KHR_node_visibility")) return "what is visible";
    if (has("KHR_lights_punctual") || has("EXT_lights_ies"))
        return words.back() == "range" ? "" : "the light of lamps";
    return has("EXT_lights_image_based") ? "the sky" : "";
}

// Whether a property has two values while the shutter is open, at the steps or at its keys.
bool changes_while_open(const Keyframes& keys, const GltfClip& clip,
                        const AnimationChoice& choice) {
    std::vector<std::vector<double>> values;
    for (size_t i = 0; i <= kMostSegments; ++i) {
        const double share = double(i) / double(kMostSegments) - 0.5;
        values.push_back(keys.at(local_s(clip, choice, share)));
    }
    const Reach reach(clip, choice);
    for (const double key_s : keys.times_s)
        if (reach.meets(key_s, key_s)) values.push_back(keys.at(key_s));
    return changes(values);
}

}  // namespace

/// The clips of a file on their way through the time steps of an exposure.
class NodeMotion::Player {
  public:
    Player(const json& posed, std::span<const GltfClip> clips, const AnimationChoice& choice)
        : choice_(choice), posed_(posed) {
        for (const GltfClip& clip : clips)
            for (const AnimatedProperty& property : clip.properties) add(clip, property);
    }

    [[nodiscard]] const json& nodes() const { return member(posed_, "nodes"); }
    /// Tracks of numbers of cameras, by their pointers.
    [[nodiscard]] const std::map<std::string, Track>& cameras() const { return of_cameras_; }
    [[nodiscard]] const json& node(int index) const { return nodes()[static_cast<size_t>(index)]; }
    /// Tracks that place a node; nullptr where it is not moved by itself.
    [[nodiscard]] const Tracks* placing(int node) const {
        const Tracks* const tracks = found_in(of_nodes_, node);
        return tracks && tracks->moves() ? tracks : nullptr;
    }
    /// Tracks of the morph weights that a node shows: its own, else those of its mesh, where the
    /// node stores none that go before.
    [[nodiscard]] std::span<const Track> weighing(int index) const {
        const json& mesh = member(node(index), "mesh");
        if (mesh.is_null()) return {};
        const Tracks* const own = found_in(of_nodes_, index);
        if (own && !own->weights.empty()) return own->weights;
        if (node(index).contains("weights")) return {};
        const Tracks* const of_mesh = found_in(of_meshes_, mesh.get<int>());
        return of_mesh ? of_mesh->weights : std::span<const Track>();
    }
    /// Weights that a node shows in the middle.
    [[nodiscard]] std::vector<double> weights(int index) const {
        if (node(index).contains("weights")) return list(node(index), "weights");
        return list(posed_["meshes"][node(index)["mesh"].get<size_t>()], "weights");
    }

    void set_steps(size_t steps) { steps_ = steps; }
    [[nodiscard]] size_t steps() const { return steps_; }
    /// Values of a track at a step.
    [[nodiscard]] std::vector<double> at(const Track& track, size_t step) const {
        const double share = double(step) / double(steps_ - 1) - 0.5;
        return track.keys->at(local_s(*track.clip, choice_, share));
    }
    /// Writes the values of a track at a step, if it has keys.
    template <size_t N>
    void play(const Track& track, size_t step, std::array<double, N>& to) const {
        if (!track.keys) return;
        const std::vector<double> values = at(track, step);
        std::copy_n(values.begin(), N, to.begin());
    }
    /// Whether keys of a track lie closer together than time steps.
    [[nodiscard]] bool has_keys_between_steps(const Track& track) const {
        const double step_s = choice_.open_s / double(steps_ - 1);
        return track.keys && io::has_keys_between_steps(track, choice_, step_s);
    }
    /// The greatest angle that a track turns by from one step to the next.
    [[nodiscard]] double turn_rad(const Track& track) const {
        double most = 0;
        std::array<double, 4> before{}, now{};
        for (size_t step = 0; track.keys && step < steps_; ++step) {
            play(track, step, now);
            double dot = 0;
            for (size_t k = 0; k < 4; ++k) dot += before[k] * now[k];
            if (step > 0) most = std::max(most, 2 * std::acos(std::min(std::fabs(dot), 1.)));
            before = now;
        }
        return most;
    }

  private:
    void add(const GltfClip& clip, const AnimatedProperty& property) {
        const auto words = words_of(property.pointer);
        if (words[0] == "cameras") of_cameras_[property.pointer] = {&property.keys, &clip};
        if (words.size() < 3 || (words[0] != "nodes" && words[0] != "meshes")) return;
        Tracks& tracks = (words[0] == "nodes" ? of_nodes_ : of_meshes_)[number_in(words[1])];
        const Track track{&property.keys, &clip, words.size() > 3 ? number_in(words[3]) : -1};
        if (words[2] == "translation") tracks.translation = track;
        if (words[2] == "rotation") tracks.rotation = track;
        if (words[2] == "scale") tracks.scale = track;
        if (words[2] == "weights") tracks.weights.push_back(track);
    }

    const AnimationChoice& choice_;
    const json& posed_;
    size_t steps_ = 0;
    std::map<int, Tracks> of_nodes_, of_meshes_;
    std::map<std::string, Track> of_cameras_;
};

NodeMotion::NodeMotion(const json& posed, std::span<const GltfClip> clips,
                       const AnimationChoice& choice, const NodeTree& tree) {
    if (!(choice.open_s > 0) || clips.empty()) return;
    Player player(posed, clips, choice);
    // Nodes that tracks move, or that hang on one of these, each after its parent.
    std::vector<bool> moves(tree.parent.size(), false);
    std::vector<int> moving;
    for (const int i : tree.order) {
        const auto index = static_cast<size_t>(i);
        const int up = tree.parent[index];
        moves[index] = player.placing(i) || (up >= 0 && moves[static_cast<size_t>(up)]);
        if (moves[index]) moving.push_back(i);
    }
    steps_ = segments_for(moving.size()) + 1;
    player.set_steps(steps_);
    add_places(player, tree, moving);
    add_weights(player);
    add_cameras(player);
}

void NodeMotion::add_places(const Player& player, const NodeTree& tree,
                            std::span<const int> moving) {
    std::map<int, double> turns_rad;  // with what a node hangs on
    for (const int i : moving) {
        const int up = tree.parent[static_cast<size_t>(i)];
        const std::vector<M44d>* const above = up >= 0 ? places(up) : nullptr;
        const M44d still_above = up >= 0 ? tree.to_world[static_cast<size_t>(up)] : M44d();
        double& turn_rad = turns_rad[i] = up >= 0 ? turns_rad[up] : 0;
        const Tracks* const own = player.placing(i);
        NodePlace local = stored_place(player.node(i));
        M44d matrix = stored_matrix(player.node(i));
        std::vector<M44d> all(steps_);
        for (size_t step = 0; step < steps_; ++step) {
            if (own) {
                player.play(own->translation, step, local.translation);
                player.play(own->rotation, step, local.rotation);
                player.play(own->scale, step, local.scale);
                matrix = local.matrix();
            }
            all[step] = matrix * (above ? (*above)[step] : still_above);
        }
        if (own) {
            turn_rad += player.turn_rad(own->rotation);
            for (const Track& track : {own->translation, own->rotation, own->scale})
                unseen_ |= player.has_keys_between_steps(track);
        }
        unseen_ |= turn_rad > std::numbers::pi;
        if (changes(all)) places_.emplace(i, std::move(all));
    }
}

void NodeMotion::add_weights(const Player& player) {
    for (int i = 0; i < static_cast<int>(player.nodes().size()); ++i) {
        const auto played = player.weighing(i);
        if (played.empty()) continue;
        std::vector<std::vector<double>> all(steps_, player.weights(i));
        for (const Track& track : played) {
            unseen_ |= player.has_keys_between_steps(track);
            const auto element = static_cast<size_t>(track.element);
            for (size_t step = 0; step < steps_; ++step) {
                const std::vector<double> values = player.at(track, step);
                if (track.element < 0)
                    all[step] = values;
                else if (element < all[step].size())
                    all[step][element] = values[0];
            }
        }
        if (changes(all)) weights_.emplace(i, std::move(all));
    }
}

void NodeMotion::add_cameras(const Player& player) {
    for (const auto& [pointer, track] : player.cameras()) {
        std::vector<std::vector<double>> all;
        for (size_t step = 0; step < steps_; ++step) all.push_back(player.at(track, step));
        if (!changes(all)) continue;
        unseen_ |= player.has_keys_between_steps(track);
        for (const auto& value : all) of_cameras_[pointer].push_back(value[0]);
    }
}

const std::vector<M44d>* NodeMotion::places(int node) const {
    return found_in(places_, node);
}

const std::vector<std::vector<double>>* NodeMotion::weights(int node) const {
    return found_in(weights_, node);
}

const std::vector<double>* NodeMotion::of_camera(const std::string& pointer) const {
    return found_in(of_cameras_, pointer);
}

std::set<std::string> held_while_open(std::span<const GltfClip> clips,
                                      const AnimationChoice& choice) {
    std::set<std::string> held;
    for (const GltfClip& clip : clips)
        for (const AnimatedProperty& property : clip.properties)
            if (const std::string what = what_holds(property.pointer);
                !what.empty() && changes_while_open(property.keys, clip, choice))
                held.insert(what);
    return held;
}

}  // namespace petzval::io
