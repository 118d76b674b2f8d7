// SPDX-License-Identifier: Apache-2.0
#include "apps/state/render_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <span>

#include "apps/setup/develop.h"
#include "apps/setup/input_files.h"
#include "integrator/render/noise_target.h"
#include "io/base/printable.h"
#include "io/file/read_file.h"
#include "io/image/display_files.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::ordered_json;

/// Key of a float, which is kept as text: JSON has no infinity.
constexpr const char* kFloat = "float";

/// FNV-1a of texts and numbers, one after the other.
class Hash {
  public:
    void add(std::string_view text) {
        add_bytes({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
        add(static_cast<uint64_t>(text.size()));  // or "ab", "c" would be "a", "bc"
    }
    void add(uint64_t number) {
        add_bytes({reinterpret_cast<const uint8_t*>(&number), sizeof number});
    }
    void add(float number) { add(uint64_t(std::bit_cast<uint32_t>(number))); }
    void add(const V3f& v) {
        for (int i = 0; i < 3; ++i) add(v[i]);
    }
    void add_bytes(std::span<const uint8_t> bytes) { hash_ = io::fnv1a(bytes, hash_); }
    [[nodiscard]] std::string text() const { return fmt::format("{:016x}", hash_); }

  private:
    uint64_t hash_ = io::fnv1a({});
};

// Where the camera stands, and how large an orthographic view is: the metadata have less.
std::string hash_of_pose(const CameraReport& camera) {
    Hash hash;
    for (const auto& row : camera.to_world.x)
        for (const float number : row) hash.add(number);
    hash.add(camera.ymag_m);
    return hash.text();
}

// What the pilots of lights and of targets found.
std::string hash_of_learned(const RenderSetup& setup) {
    Hash hash;
    if (const auto& lights = setup.prepared.lights)
        for (const float factor : lights->shares().factors()) hash.add(factor);
    const camera::TargetGrid* const targets = setup.view.targets.get();
    if (!targets) return hash.text();
    for (const camera::Target& target : targets->targets) {
        hash.add(target.centre);
        hash.add(target.radius_m);
    }
    for (const camera::TargetCell& cell : targets->lists) {
        hash.add(uint64_t(cell.targets.size()));
        for (const camera::ListedTarget& listed : cell.targets) {
            hash.add(uint64_t(listed.number));
            hash.add(listed.chance);
        }
    }
    return hash.text();
}

// Without the noise that is asked for: samples of another are of the same picture.
std::string hash_of_noise(const integrator::NoiseTarget& target) {
    Hash hash;
    hash.add(static_cast<float>(target.floor_nits));
    return hash.text();
}

std::string hash_of_files(const std::vector<std::filesystem::path>& files) {
    Hash hash;
    std::vector<std::string> texts;
    for (const auto& file : files) texts.push_back(io::name_and_hash(file));
    std::sort(texts.begin(), texts.end());  // folders are listed in any order
    for (const std::string& text : texts) hash.add(text);
    return hash.text();
}

std::string text_of(const io::Metadata::value_type::second_type& value) {
    return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

// "petzval:lensRadius_m" reads "lensRadius_m".
std::string_view short_name(std::string_view name) {
    return name.substr(name.starts_with("petzval:") ? sizeof "petzval:" - 1 : 0);
}

std::string shape_text(const io::FilmShape& shape) {
    std::vector<std::string_view> layers;
    for (const Aov layer : shape.layers) layers.push_back(aov_info(layer).name);
    std::string text =
        fmt::format("{}x{} px, layers {}", shape.full_size.x, shape.full_size.y,
                    layers.empty() ? "none" : fmt::format("{}", fmt::join(layers, ",")));
    if (shape.keeps.blocks) text += ", what tells the noise";
    if (shape.keeps.halves) text += ", what a denoiser needs";
    if (const auto& b = shape.bins)
        text += fmt::format(", bins {:.9g}:{:.9g}:{:.9g}", b->first_edge_nm, b->last_edge_nm(),
                            b->width_nm);
    return text;
}

RenderFacts::Texts all_of(const ComparedRender& render, Compare compare) {
    const RenderFacts& facts = render.facts;
    RenderFacts::Texts out{{"frame", shape_text(render.shape)}};
    for (const auto& [name, value] : facts.metadata)
        if (name != kNoiseTarget && (name != kFoundExposure || compare == Compare::Pictures))
            out.emplace_back(short_name(name), text_of(value));
    out.insert(out.end(), facts.inputs.begin(), facts.inputs.end());
    if (compare == Compare::Pictures)
        out.insert(out.end(), facts.display.begin(), facts.display.end());
    return out;
}

}  // namespace

RenderFacts::Texts display_facts(const io::DisplayOptions& display) {
    return {{"exposure", fmt::format("{}", display.exposure_ev)},
            {"view", display.view},
            {"OpenColorIO configuration", display.config.empty()
                                              ? std::string("Petzval's own")
                                              : hash_of_files(io::display_files(display.config))}};
}

RenderFacts facts_of(const RenderSetup& setup, const integrator::RenderJob& job,
                     const integrator::PathOptions& path, const io::DisplayOptions& display) {
    RenderFacts facts;
    facts.metadata = describe_render(setup, job, path);
    std::vector<std::filesystem::path> own;
    for (const io::NamedFile& file : own_files()) own.push_back(file.path);
    facts.inputs.emplace_back("Petzval's own files", hash_of_files(own));
    const auto add = [&](const io::NamedFile& file) {
        std::error_code error;  // of a name that is no file the metadata say all
        if (!std::filesystem::is_regular_file(file.path, error)) return;
        std::string name = file.role;  // several catalogues have one role
        const auto taken = [&](const auto& one) { return one.first == name; };
        for (int i = 2; std::any_of(facts.inputs.begin(), facts.inputs.end(), taken); ++i)
            name = fmt::format("{} {}", file.role, i);
        facts.inputs.emplace_back(name, io::visible(io::name_and_hash(file.path)));
    };
    // The hash of the scene's own files is in the metadata.
    for (const io::NamedFile& file : input_files(setup.from.asked))
        if (file.path != setup.from.asked.scene && file.path != setup.from.asked.environment)
            add(file);
    for (const io::NamedFile& file : setup.prepared.files)
        if (file.role == kCameraFile) add(file);
    facts.inputs.emplace_back("pose of the camera", hash_of_pose(setup.from.camera));
    facts.inputs.emplace_back("what pilots learned", hash_of_learned(setup));
    facts.noise = job.noise;
    if (job.noise) facts.inputs.emplace_back("what bounds the noise", hash_of_noise(*job.noise));
    facts.display = display_facts(display);
    return facts;
}

Json to_json(const RenderFacts& facts) {
    Json metadata = Json::array();
    for (const auto& [name, value] : facts.metadata)
        if (const float* number = std::get_if<float>(&value))
            metadata.push_back({name, {{kFloat, fmt::format("{}", *number)}}});
        else if (const int* whole = std::get_if<int>(&value))
            metadata.push_back({name, *whole});
        else
            metadata.push_back({name, std::get<std::string>(value)});
    Json out{
        {"metadata", std::move(metadata)}, {"inputs", facts.inputs}, {"display", facts.display}};
    if (const auto& noise = facts.noise)
        out["noise"] = {{"target", noise->noise},
                        {"floor_nits", noise->floor_nits},
                        {"frame_px", {noise->frame_px.x, noise->frame_px.y}},
                        {"least", noise->least}};
    return out;
}

RenderFacts facts_from(const Json& json) {
    RenderFacts facts;
    for (const Json& one : json.at("metadata")) {
        const auto name = one.at(0).get<std::string>();
        const Json& value = one.at(1);
        if (value.is_string())
            facts.metadata.emplace_back(name, value.get<std::string>());
        else if (value.is_number_integer())
            facts.metadata.emplace_back(name, value.get<int>());
        else
            facts.metadata.emplace_back(
                name, std::strtof(value.at(kFloat).get<std::string>().c_str(), nullptr));
    }
    json.at("inputs").get_to(facts.inputs);
    json.at("display").get_to(facts.display);
    if (json.contains("noise")) {
        const Json& noise = json.at("noise");
        auto target = std::make_shared<integrator::NoiseTarget>();
        target->noise = noise.at("target").get<double>();
        target->floor_nits = noise.at("floor_nits").get<double>();
        target->frame_px = {noise.at("frame_px").at(0).get<int>(),
                            noise.at("frame_px").at(1).get<int>()};
        noise.at("least").get_to(target->least);
        facts.noise = std::move(target);
    }
    return facts;
}

std::optional<std::string> difference(const ComparedRender& a, const ComparedRender& b,
                                      Compare compare) {
    const auto of_a = all_of(a, compare), of_b = all_of(b, compare);
    const auto find = [](const RenderFacts::Texts& in, const std::string& name) {
        const auto found =
            std::find_if(in.begin(), in.end(), [&](const auto& one) { return one.first == name; });
        return found == in.end() ? std::string("absent") : found->second;
    };
    for (const auto* texts : {&of_a, &of_b})
        for (const auto& [name, value] : *texts)
            if (const std::string in_a = find(of_a, name), in_b = find(of_b, name); in_a != in_b)
                return fmt::format("{} is {} in {} and {} in {}", name, in_a, a.name, in_b, b.name);
    return std::nullopt;
}

std::string light_hash(const RenderFacts& facts, const io::FilmShape& shape, SampleRange samples) {
    Hash hash;
    for (const auto& [name, value] : facts.metadata) {
        if (name == kFoundExposure) continue;  // of the display
        hash.add(name);
        hash.add(text_of(value));
    }
    for (const auto& [name, value] : facts.inputs) {
        hash.add(name);
        hash.add(value);
    }
    hash.add(shape_text(shape));
    for (const int edge : {shape.crop.x0, shape.crop.y0, shape.crop.x1, shape.crop.y1})
        hash.add(static_cast<uint64_t>(edge));
    hash.add(uint64_t(samples.first));
    hash.add(uint64_t(samples.end));
    return hash.text();
}

std::string display_hash(const RenderFacts::Texts& display) {
    Hash hash;
    for (const auto& [name, value] : display) {
        hash.add(name);
        hash.add(value);
    }
    return hash.text();
}

}  // namespace petzval::apps
