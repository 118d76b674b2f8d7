// SPDX-License-Identifier: Apache-2.0
// Valid glTF files that combine what meshes may have: skins, morph targets, normals, tangents,
// several sets of texture coordinates, colours, every format, every topology and every way to store
// it, mirrored textures, repeated vertices, shared meshes, instances. A seed draws each of them.
#pragma once

#include <set>

#include "tests/support/animation/animated_gltf.h"
#include "tests/support/combined/attributes.h"
#include "tests/support/tiny_png.h"

namespace petzval::test {

/// Such a file. Its animation runs from 0 to 2 s; at 0 s, and without it, the file is at rest: each
/// joint stands as it was bound, and every morph weight is 0. Skinned nodes have no place of their
/// own. Joints are the first nodes.
class CombinedGltf : public AnimatedGltf {
  public:
    /// plain: the same without interleaving, sparse accessors, compression and instancing.
    explicit CombinedGltf(uint32_t seed, bool plain = false)
        : dice_(seed), plain_(plain), writer_(*this) {
        joints_ = 1 + dice_.below(4);
        targets_ = dice_.comes(50) ? 1 + dice_.below(3) : 0;
        skinned_ = dice_.comes(65);
        add_joints();
        add_materials();
        nlohmann::json mesh;
        for (size_t i = 0, count = 1 + dice_.below(2); i < count; ++i)
            mesh["primitives"].push_back(primitive());
        if (targets_ > 0) mesh["weights"] = std::vector<double>(targets_, 0.);
        add("meshes", std::move(mesh));
        add_nodes();
        writer_.end();
    }

    CombinedGltf(const CombinedGltf&) = delete;
    CombinedGltf& operator=(const CombinedGltf&) = delete;

    /// Whether texture coordinates are morphed: while a shutter is open they stay as in the middle.
    [[nodiscard]] bool morphs_uv() const { return morphs_uv_; }

  private:
    struct Patch {
        std::vector<Attribute> attributes;
        std::vector<std::vector<Attribute>> targets;
        std::vector<uint32_t> indices;  ///< of a list of triangles
        size_t columns = 0, rows = 0, vertices = 0;
    };

    // A chain whose matrices and their inverses are exact: powers of two and their sums.
    void add_joints() {
        const bool mirrored = dice_.comes(20);
        double x_scale = 1, y = 0, scale = 1;
        for (size_t j = 0; j < joints_; ++j) {
            nlohmann::json node = {{"translation", {0, 0.25, 0}}};
            y += 0.25 * scale;
            if (j == 0 && mirrored) {
                node["scale"] = {-1, 1, 1};
                x_scale = -1;
            } else if (j == 1 && dice_.comes(30)) {
                node["scale"] = {2, 2, 2};
                scale = 2;
            }
            if (j + 1 < joints_) node["children"] = {j + 1};
            add("nodes", std::move(node));
            bind_.insert(bind_.end(), {float(x_scale / scale), 0, 0, 0, 0, float(1 / scale), 0, 0,
                                       0, 0, float(1 / scale), 0, 0, float(-y / scale), 0, 1});
        }
        json["scene"] = 0;
        json["scenes"] = {{{"nodes", {0}}}};
        for (size_t j = 0; j < joints_; ++j) animate_joint(int(j));
    }

    void animate_joint(int j) {
        const auto& node = json["nodes"][size_t(j)];
        const auto at_rest = node.value("scale", std::vector<float>{1, 1, 1});
        std::vector<float> turns = {0, 0, 0, 1};
        for (int key = 0; key < 2; ++key) {
            const double x = dice_.between(-0.4, 0.4), y = dice_.between(-0.4, 0.4), z = 0.2;
            const double w = std::sqrt(1 - x * x - y * y - z * z);
            for (const double part : {x, y, z, w}) turns.push_back(float(part));
        }
        add_channel(node_target(j, "rotation"), {0, 1, 2}, "VEC4", turns);
        if (dice_.comes(50))
            add_channel(node_target(j, "translation"), {0, 2}, "VEC3",
                        {0, 0.25f, 0, float(dice_.between(-1, 1)), 0.5f, 0.25f});
        if (j == 0 && dice_.comes(25)) {  // what hangs on it is mirrored as a whole
            add_channel(node_target(j, "scale"), {0, 0.25f}, "VEC3",
                        {at_rest[0], at_rest[1], at_rest[2], -at_rest[0], at_rest[1], at_rest[2]},
                        "STEP");
        } else if (dice_.comes(40)) {
            std::vector<float> sizes = at_rest;
            for (size_t k = 0; k < 3; ++k)
                sizes.push_back(at_rest[k] * float(dice_.between(0.5, 1.5)));
            add_channel(node_target(j, "scale"), {0, 2}, "VEC3", sizes);
        }
    }

    void add_materials() {
        add("textures", {{"source", add_image(tiny_png(1, 1, {120, 140, 240, 255}))}});
        for (int set = 0; set < 3; ++set) {
            nlohmann::json map = {{"index", 0}, {"texCoord", set}};
            if (dice_.comes(50)) {
                map["extensions"]["KHR_texture_transform"] = {
                    {"offset", {0.25, -0.5}},
                    {"rotation", dice_.between(-3, 3)},
                    {"scale", {dice_.comes(50) ? -0.5 : 0.25, 0.5}}};
                writer_.use("KHR_texture_transform", false);
            }
            const int at = add("materials", {{"normalTexture", map}});
            if (dice_.comes(30))
                json["materials"][size_t(at)]["pbrMetallicRoughness"]["baseColorTexture"] = {
                    {"index", 0}};
        }
        add("materials", {{"alphaMode", "MASK"}});
    }

    /// Drops those of the named formats that need KHR_mesh_quantization where it is not used.
    template <size_t n, size_t m>
    Format format(const Format (&always)[n], const Format (&quantized)[m]) {
        if (!dice_.comes(35)) return dice_.one_of(always);
        writer_.use("KHR_mesh_quantization");
        return dice_.one_of(quantized);
    }

    Patch patch() {
        Patch out;
        const size_t nx = out.columns = 2 + dice_.below(5), ny = out.rows = 2 + dice_.below(3);
        out.vertices = nx * ny;
        const double bump = dice_.comes(30) ? 0 : 0.3, tilt = dice_.between(-1, 1);
        std::vector<double> p, n;
        for (size_t v = 0; v < out.vertices; ++v) {
            const double x = 2. * double(v % nx) / double(nx - 1) - 1;
            const double y = double(v / nx) / double(ny - 1) + 0.1 * tilt * x;
            p.insert(p.end(), {0.9 * x, 0.8 * y, bump * std::sin(3 * x + 2 * y)});
            const double nz = 1 / std::sqrt(1 + bump * bump * (x * x + y * y));
            n.insert(n.end(), {bump * x * nz, bump * y * nz, nz});
        }
        add_attribute(out, "POSITION", 3, format({kFloat}, {kI16n, kI8n, kI8, kI16}), p, 30);
        if (dice_.comes(70)) {
            add_attribute(out, "NORMAL", 3, format({kFloat}, {kI16n, kI8n}), n, 1);
            if (dice_.comes(35)) add_tangents(out, n);
        }
        for (uint32_t set = 0, sets = dice_.below(4); set < sets; ++set) add_uv(out, set);
        if (dice_.comes(50)) {
            std::vector<double> colours;
            const size_t width = 3 + dice_.below(2);
            for (size_t i = 0; i < out.vertices * width; ++i)
                colours.push_back(dice_.between(0, 1));
            add_attribute(out, "COLOR_0", width, dice_.one_of({kFloat, kU8n, kU16n}), colours, 1);
        }
        if (skinned_) add_influences(out);
        for (uint32_t y = 0; y + 1 < ny; ++y)
            for (uint32_t x = 0; x + 1 < nx; ++x) {
                const auto a = uint32_t(y * nx + x), b = a + 1, c = uint32_t(a + nx), d = c + 1;
                out.indices.insert(out.indices.end(), {a, b, c, c, b, d});
            }
        return out;
    }

    // Whole numbers are `of_integers` times as large.
    static void add_attribute(Patch& to, const std::string& name, size_t width, Format format,
                              std::vector<double> values, double of_integers) {
        if (format.component != kFloat.component && !format.normalized)
            for (double& x : values) x *= of_integers;
        to.attributes.push_back({name, width, format, std::move(values)});
    }

    void add_tangents(Patch& to, const std::vector<double>& n) {
        std::vector<double> tangents;
        for (size_t v = 0; v < to.vertices; ++v) {  // across the normal: its x and z turned
            const double x = n[3 * v + 2], z = -n[3 * v], length = std::hypot(x, z);
            tangents.insert(tangents.end(), {x / length, 0, z / length, dice_.comes(50) ? 1. : -1});
        }
        add_attribute(to, "TANGENT", 4, format({kFloat}, {kI16n, kI8n}), tangents, 1);
    }

    // Upright, mirrored at the middle, folded at random, or of no use.
    void add_uv(Patch& to, uint32_t set) {
        const uint32_t kind = dice_.below(5);
        std::vector<double> uv;
        for (size_t v = 0; v < to.vertices; ++v) {
            const auto& p = to.attributes[0].values;
            const double x = double(v % to.columns) / double(to.columns - 1);
            const double u = kind == 0   ? x
                             : kind <= 2 ? std::fabs(2 * x - 1)
                             : kind == 3 ? dice_.between(0, 1)
                                         : 0.5;
            uv.insert(uv.end(), {u, kind == 4 ? 0.5 : 1 - double(v / to.columns) / 4 + 0 * p[0]});
        }
        add_attribute(to, "TEXCOORD_" + std::to_string(set), 2,
                      format({kFloat, kU8n, kU16n}, {kI8, kU8, kI16, kU16, kI16n}), uv, 7);
    }

    void add_influences(Patch& to) {
        const size_t sets = dice_.comes(25) ? 2 : 1, each = 4 * sets;
        const Format of_weights = dice_.one_of({kFloat, kU8n, kU16n});
        std::vector<double> joints(to.vertices * each), weights(to.vertices * each);
        for (size_t v = 0; v < to.vertices; ++v) {
            int left = 255;  // in 8 bits they add up to 1 exactly
            for (size_t k = 0; k < each; ++k) {
                const int weight = k + 1 == each ? left : int(dice_.below(size_t(left) + 1));
                left -= weight;
                weights[v * each + k] = weight / 255.;
                joints[v * each + k] = weight > 0 ? dice_.below(joints_) : 0;
            }
        }
        const auto part = [&](const std::vector<double>& all, size_t set) {
            std::vector<double> out;
            for (size_t i = 0; i < all.size(); ++i)
                if (i % each / 4 == set) out.push_back(all[i]);
            return out;
        };
        const Format of_joints = dice_.one_of({kU8, kU16});
        for (size_t set = 0; set < sets; ++set) {
            const std::string number = std::to_string(set);
            add_attribute(to, "JOINTS_" + number, 4, of_joints, part(joints, set), 1);
            add_attribute(to, "WEIGHTS_" + number, 4, of_weights, part(weights, set), 1);
        }
    }

    void add_targets(Patch& to) {
        for (size_t t = 0; t < targets_; ++t) {
            auto& target = to.targets.emplace_back();
            for (const Attribute& base : to.attributes) {
                if (base.name.starts_with("JOINTS") || base.name.starts_with("WEIGHTS")) continue;
                if (base.name != "POSITION" && !dice_.comes(40)) continue;
                const bool of_uv = base.name.starts_with("TEXCOORD");
                morphs_uv_ |= of_uv;
                Attribute delta = base;
                delta.format = of_uv || base.name == "COLOR_0" ? dice_.one_of({kFloat, kU8n, kU16n})
                                                               : format({kFloat}, {kI16n, kI8n});
                if (base.name == "TANGENT") delta.width = 3;
                delta.values.resize(base.count() * delta.width);
                for (double& x : delta.values) x = dice_.between(of_uv ? 0 : -0.3, of_uv ? 1 : 0.3);
                if (base.name == "COLOR_0")
                    for (double& x : delta.values) x = dice_.between(0, 0.9);
                target.push_back(std::move(delta));
            }
        }
    }

    static void gather(Patch& patch, const std::vector<uint32_t>& from) {
        for (Attribute& attribute : patch.attributes) attribute.gather(from);
        for (auto& target : patch.targets)
            for (Attribute& attribute : target) attribute.gather(from);
        patch.vertices = from.size();
    }

    // Some corners get copies of their vertices, with other joints perhaps; a vertex of no
    // triangle, and triangles of two corners.
    void repeat_vertices(Patch& patch) {
        std::vector<uint32_t> from(patch.vertices);
        for (uint32_t v = 0; v < from.size(); ++v) from[v] = v;
        for (uint32_t& corner : patch.indices)
            if (dice_.comes(20)) {
                from.push_back(corner);
                corner = uint32_t(from.size() - 1);
            }
        from.push_back(0);
        gather(patch, from);
        const uint32_t a = patch.indices[0], b = patch.indices[1];
        patch.indices.insert(patch.indices.end(), {a, a, b, b, a, b});
    }

    nlohmann::json primitive() {
        Patch made = patch();
        add_targets(made);
        nlohmann::json out;
        const int material = material_of(made);
        if (material >= 0) out["material"] = material;
        const int mode = dice_.one_of({4, 4, 4, 5, 6});
        bool loose = false;
        if (mode == 4) {
            if ((loose = dice_.comes(40))) repeat_vertices(made);
        } else if (mode == 5) {
            made.indices = strip(made);
        } else {
            made.indices.resize(made.vertices);  // from its first corner
            for (uint32_t v = 0; v < made.vertices; ++v) made.indices[v] = v;
        }
        out["mode"] = mode;
        const Storage drawn = dice_.one_of({Storage::Plain, Storage::Interleaved, Storage::Sparse,
                                            Storage::Meshopt, Storage::Draco});
        const Storage storage = plain_ ? Storage::Plain : drawn;
        if (drawn == Storage::Draco && mode == 4) {
            if (storage == Storage::Draco)
                writer_.write_draco(made.attributes, made.indices, loose || targets_ > 0, out);
            else
                write_plain(made, out, storage, true);
        } else {
            write_plain(made, out, storage, dice_.comes(60));
        }
        for (const auto& target : made.targets) {
            Dice own(uint32_t(made.vertices));
            out["targets"].push_back(
                writer_.write(target, storage == Storage::Draco ? Storage::Plain : storage, own));
        }
        return out;
    }

    void write_plain(Patch& made, nlohmann::json& out, Storage storage, bool indexed) {
        if (!indexed) gather(made, made.indices);
        Dice own(uint32_t(made.vertices));  // so that the plain twin draws what this file does
        out["attributes"] = writer_.write(made.attributes, storage, own);
        if (indexed)
            out["indices"] =
                writer_.write_indices(made.indices, made.vertices, out["mode"] == 4, storage, own);
    }

    // Row after row, joined by triangles without area.
    static std::vector<uint32_t> strip(const Patch& patch) {
        std::vector<uint32_t> out;
        for (size_t y = 0; y + 1 < patch.rows; ++y) {
            const auto first = uint32_t(y * patch.columns);
            if (y > 0) out.insert(out.end(), {out.back(), first + uint32_t(patch.columns)});
            for (uint32_t x = 0; x < patch.columns; ++x)
                out.insert(out.end(), {first + uint32_t(patch.columns) + x, first + x});
        }
        return out;
    }

    int material_of(const Patch& patch) {
        uint32_t sets = 0;
        for (const Attribute& attribute : patch.attributes)
            sets += attribute.name.starts_with("TEXCOORD");
        if (sets == 0) return dice_.comes(50) ? 3 : -1;
        return dice_.comes(80) ? int(dice_.below(sets)) : -1;
    }

    // The mesh once or twice: with two skins, or at places of which one may mirror.
    void add_nodes() {
        std::vector<size_t> joints(joints_);
        for (size_t j = 0; j < joints_; ++j) joints[j] = j;
        for (size_t i = 0, count = 1 + dice_.below(2); i < count; ++i) {
            nlohmann::json node = {{"mesh", 0}};
            if (skinned_) {
                node["skin"] =
                    add("skins", {{"joints", joints},
                                  {"inverseBindMatrices", add_accessor<float>("MAT4", bind_)}});
                turn_about(joints);
            } else {
                node["translation"] = {2. * double(i), 0, 0.5};
                node["scale"] = {dice_.comes(40) ? -1.5 : 1.5, 1, 0.75};
            }
            const bool many = !skinned_ && dice_.comes(35);
            const std::vector<int> shown = many ? add_instances(node) : std::vector<int>{};
            const int at = add_root(std::move(node));
            if (targets_ > 0) animate_weights(shown.empty() ? std::vector<int>{at} : shown);
            if (!skinned_ && dice_.comes(40))
                add_channel(node_target(at, "rotation"), {0, 1, 2}, "VEC4",
                            {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0.6f, 0, 0, 0.8f});
        }
    }

    // The next skin has its joints, and their matrices, the other way about. The chain's matrices
    // differ, so that the same numbers mean other joints.
    void turn_about(std::vector<size_t>& joints) {
        std::reverse(joints.begin(), joints.end());
        std::vector<float> turned;
        for (size_t j = joints_; j-- > 0;)
            turned.insert(turned.end(), bind_.begin() + std::ptrdiff_t(16 * j),
                          bind_.begin() + std::ptrdiff_t(16 * j + 16));
        bind_ = turned;
    }

    /// Shows a node's mesh at one to three places about it: by instancing, or as the plain twin by
    /// a child each. The nodes that show it; none where the node itself does.
    std::vector<int> add_instances(nlohmann::json& node) {
        std::vector<int> children;
        std::vector<float> places, turns, sizes;
        for (size_t i = 0, count = 1 + dice_.below(3); i < count; ++i) {
            const std::vector<float> place = {float(dice_.between(-1, 1)), 0, -2 * float(i)};
            const std::vector<float> turn = dice_.comes(50) ? std::vector<float>{0, 0.6f, 0, 0.8f}
                                                            : std::vector<float>{0, 0, 0, 1};
            const std::vector<float> size = {dice_.comes(30) ? -1.f : 1.f, 1.25f, 0.75f};
            if (plain_)
                children.push_back(add(
                    "nodes",
                    {{"mesh", 0}, {"translation", place}, {"rotation", turn}, {"scale", size}}));
            places.insert(places.end(), place.begin(), place.end());
            turns.insert(turns.end(), turn.begin(), turn.end());
            sizes.insert(sizes.end(), size.begin(), size.end());
        }
        if (plain_) {
            node.erase("mesh");
            node["children"] = children;
        } else {
            writer_.use("EXT_mesh_gpu_instancing");
            node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
                {"TRANSLATION", add_accessor<float>("VEC3", places)},
                {"ROTATION", add_accessor<float>("VEC4", turns)},
                {"SCALE", add_accessor<float>("VEC3", sizes)}};
        }
        return children;
    }

    void animate_weights(const std::vector<int>& nodes) {
        std::vector<float> weights(targets_, 0.f);
        for (size_t i = 0; i < 2 * targets_; ++i) weights.push_back(float(dice_.between(-1, 1)));
        for (const int node : nodes)
            add_channel(node_target(node, "weights"), {0, 1, 2}, "SCALAR", weights);
    }

    Dice dice_;
    bool plain_, skinned_ = false, morphs_uv_ = false;
    AttributeWriter writer_;
    size_t joints_ = 0, targets_ = 0;
    std::vector<float> bind_;  ///< inverse bind matrices
};

}  // namespace petzval::test
