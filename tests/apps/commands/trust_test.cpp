// SPDX-License-Identifier: Apache-2.0
// Builds, states and pictures that are not what they seem, and files that never end.
#include <sys/stat.h>

#include <cstring>
#include <regex>

#include "io/file/read_file.h"
#include "io/picture/seal.h"
#include "tests/apps/commands/long_renders.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

/// A state with another header, and with the checksum that belongs to it.
std::string with_header(const std::string& state,
                        const std::function<void(nlohmann::ordered_json&)>& edit) {
    uint64_t length = 0;
    std::memcpy(&length, state.data() + 16, 8);
    auto header = nlohmann::ordered_json::parse(state.substr(24, length));
    edit(header);
    const std::string text = header.dump();
    length = text.size();
    std::string out = state.substr(0, 16);
    out.append(reinterpret_cast<const char*>(&length), 8);
    uint64_t old = 0;
    std::memcpy(&old, state.data() + 16, 8);
    out += text + state.substr(24 + old, state.size() - 32 - old);
    const uint64_t hash = io::fnv1a({reinterpret_cast<const uint8_t*>(out.data()), out.size()});
    return out.append(reinterpret_cast<const char*>(&hash), 8);
}

class Trust : public LongRenders {
  protected:
    /// Runs the program; one that waits for ever is ended, with exit code 124.
    static Finished run_with_alarm(Words words, const std::string& program = PETZVAL_PROGRAM) {
        words.insert(words.begin(), {"60", program});
        Process process(words, {}, "/usr/bin/timeout");
        return process.wait();
    }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
    }
    std::string fifo(const std::string& name) const {
        EXPECT_EQ(mkfifo(path(name).c_str(), 0600), 0);
        return path(name);
    }
    static std::string version(const std::string& program = PETZVAL_PROGRAM) {
        const std::string out = run_with_alarm({"--version"}, program).out;
        return out.substr(0, out.find('\n'));
    }
    /// Copies a file of this build with another fact of its description, by default the hash of its
    /// sources: it is as one of another build.
    void copy_changed(const fs::path& from, const fs::path& to,
                      const std::string& before = "sources: ") const {
        const std::string out = run_petzval({"--version"}).out;
        const size_t begin = out.find(before) + before.size();
        const std::string fact = out.substr(begin, out.find('\n', begin) - begin);
        std::string bytes = file_bytes(from), other = fact;
        other.back() = other.back() == '0' ? '1' : '0';
        size_t count = 0;
        for (size_t at = 0; (at = bytes.find(fact, at)) != bytes.npos; ++count)
            bytes.replace(at, fact.size(), other);
        EXPECT_GE(count, 1u) << from;
        fs::create_directories(to.parent_path());
        std::ofstream(to, std::ios::binary) << bytes;
        fs::permissions(to, fs::perms::owner_all);
    }
    static fs::path module_from_bin() {
        const fs::path bin = fs::path(PETZVAL_PROGRAM).parent_path();
        for (const char* lib : {"lib", "lib64", "lib/x86_64-linux-gnu"})
            if (const fs::path at = fs::path("..") / lib / "petzval/petzval_io_codec.so";
                fs::exists(bin / at))
                return at;
        return {};
    }
};

TEST_F(Trust, TheVersionSaysWhatTheProgramWasBuiltFrom) {
    const std::string out = run_petzval({"--version"}).out;
    EXPECT_TRUE(std::regex_match(
        out, std::regex("petzval \\d+\\.\\d+\\.\\d+ \\(build [0-9a-f]{16}\\)\nsources: "
                        "[0-9a-f]{64}\ncompiler: .+ -.+\nlibraries: glibc .+, Embree .+\n")))
        << out;
    EXPECT_EQ(out.find(fs::path(PETZVAL_PROGRAM).parent_path().parent_path().string()), out.npos)
        << "other folders are no other build";
}

TEST_F(Trust, AnotherCompilerOrLibraryIsAnotherBuild) {
    std::set<std::string> versions{version()};
    for (const char* fact : {"sources: ", "compiler: ", "Embree "}) {
        const fs::path other = folder_.path / "other";
        copy_changed(PETZVAL_PROGRAM, other, fact);
        EXPECT_TRUE(versions.insert(version(other)).second) << fact;
    }
}

TEST_F(Trust, AnotherBuildIsRefusedByName) {
    const fs::path other = folder_.path / "other/bin/petzval", module = module_from_bin();
    ASSERT_FALSE(module.empty());
    copy_changed(PETZVAL_PROGRAM, other);
    const std::string ours = version(), theirs = version(other);
    ASSERT_EQ(ours.size(), theirs.size());
    ASSERT_NE(ours, theirs);
    const fs::path there = (other.parent_path() / module).lexically_normal();
    fs::create_directories(there.parent_path());
    fs::create_directories(folder_.path / "other/share");
    fs::create_symlink(PETZVAL_ASSETS, folder_.path / "other/share/petzval");
    fs::copy_file(fs::path(PETZVAL_PROGRAM).parent_path() / module, there);
    const Words picture = words({"--spp", "2", "-o", path("p.exr")});
    const Finished unlike = run_with_alarm(picture, other);
    EXPECT_EQ(unlike.exit_code, 1);
    EXPECT_NE(unlike.err.find("it is of " + ours + ", and this is " + theirs), std::string::npos)
        << unlike.err;
    fs::remove(there);
    copy_changed(fs::path(PETZVAL_PROGRAM).parent_path() / module, there);
    const Finished rendered = run_with_alarm(picture, other);
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    Words again = picture;
    again.emplace_back("--skip-existing");
    EXPECT_NE(run_with_alarm(again, other).err.find("is there already"), std::string::npos);
    EXPECT_EQ(run_petzval(again).err.find("is there already"), std::string::npos)
        << "the picture is stale";
    EXPECT_NE(run_petzval(again).err.find("is there already"), std::string::npos);

    const Words part = words({"--spp", "4:8", "-o", path("b.state")});
    ASSERT_EQ(run_with_alarm(part, other).exit_code, 0);
    run({"--spp", "0:4", "-o", path("a.state")});
    const std::string why =
        path("b.state") + ": was written by " + theirs + ", and this is " + ours;
    const Finished merged = merge({"a.state", "b.state"}, {"-o", path("m.exr")});
    EXPECT_EQ(merged.exit_code, 1);
    EXPECT_NE(merged.err.find(why), std::string::npos) << merged.err;
    EXPECT_FALSE(fs::exists(path("m.exr")));
    const Finished resumed = run_petzval({"resume", path("b.state")});
    EXPECT_EQ(resumed.exit_code, 1);
    EXPECT_NE(resumed.err.find(why), std::string::npos) << resumed.err;
    Words kept = part;
    kept.emplace_back("--skip-existing");
    const Finished anew = run_petzval(kept);
    EXPECT_EQ(anew.exit_code, 0);
    EXPECT_NE(anew.err.find(why), std::string::npos) << anew.err;
    EXPECT_EQ(merge({"a.state", "b.state"}, {"-o", path("m.exr")}).exit_code, 0);
}

// Nobody writes to the pipe: who opens it waits.
TEST_F(Trust, AHostileStateDoesNotHoldTheMerge) {
    run({"--spp", "0:2", "-o", path("a.state")});
    const std::string state = file_bytes(path("a.state"));
    for (const std::string& config : {fifo("pipe"), std::string("/proc/self/fd/0")}) {
        write("h.state", with_header(state, [&](auto& h) { h["run"]["display"][2] = config; }));
        const Finished done = run_with_alarm({"merge", path("h.state"), "-o", path("m.png")});
        EXPECT_EQ(done.exit_code, 1) << config << done.err;
        EXPECT_NE(done.err.find(config), std::string::npos) << done.err;
    }
    write("h.state", with_header(state, [](auto&) {}));
    EXPECT_EQ(run_with_alarm({"merge", path("h.state"), "-o", path("m.png")}).exit_code, 0);
}

TEST_F(Trust, PipesAreRefusedWhereverFilesAreRead) {
    const std::string pipe = fifo("pipe"), out = path("o.exr");
    for (const Words& words : {Words{"info", pipe},
                               {"render", pipe, "-o", out},
                               {"render", scene_, "--env", pipe, "-o", out},
                               {"render", scene_, "--illuminant", pipe, "-o", out},
                               {"render", scene_, "--ocio", pipe, "-o", path("o.png")},
                               {"image", "stats", pipe},
                               {"image", "diff", pipe, pipe},
                               {"resume", pipe},
                               {"merge", pipe, "-o", out}}) {
        const Finished done = run_with_alarm(words);
        EXPECT_TRUE(done.exit_code == 1 || done.exit_code == 2) << words[0] << done.err;
    }
}

TEST_F(Trust, HarmedPicturesAreRenderedAnew) {
    const Words asked = words({"--spp", "2", "-o", path("p.exr"), "-o", path("p.png"), "-o",
                               path("p.jpg"), "--skip-existing"});
    const auto is_there = [&] {
        const Finished done = run_petzval(asked);
        EXPECT_EQ(done.exit_code, 0) << done.err;
        return done.err.find("is there already") != std::string::npos;
    };
    EXPECT_FALSE(is_there());
    EXPECT_TRUE(is_there());
    for (const char* name : {"p.exr", "p.png", "p.jpg"}) {
        const std::string good = file_bytes(path(name));
        std::string sealed;
        for (const auto& [key, value] : io::read_metadata(path(name)))
            if (key == io::kSealName) sealed = std::get<std::string>(value);
        EXPECT_TRUE(io::is_as_written(path(name), sealed)) << name;
        for (size_t at = 8; at < good.size(); at += 1 + good.size() / 300) {
            std::string bad = good;
            bad[at] = char(bad[at] ^ 4);
            write(name, bad);
            EXPECT_FALSE(io::is_as_written(path(name), sealed)) << name << ' ' << at;
        }
        std::string bad = good;
        bad[good.size() * 2 / 3] = char(bad[good.size() * 2 / 3] ^ 1);
        write(name, bad);
        EXPECT_FALSE(is_there()) << name;
        EXPECT_TRUE(file_bytes(path(name)) == good) << name;
        write(name, good.substr(0, good.size() - 12));  // of a PNG: its IEND
        EXPECT_FALSE(is_there()) << name;
        EXPECT_TRUE(is_there()) << name;
    }
}

TEST_F(Trust, ExtensionsThatAreNoListAreNamed) {
    const std::pair<const char*, nlohmann::json> cases[] = {
        {"extensionsUsed", 5126},
        {"extensionsUsed", "KHR_materials_specular"},
        {"extensionsUsed", {"KHR_materials_specular", 1}},
        {"extensionsRequired", 5126},
        {"extensionsRequired", "KHR_materials_specular"}};
    for (const auto& [key, value] : cases) {
        TinyGltf file = studio();
        file.json[key] = value;
        for (auto& accessor : file.json["accessors"])
            if (accessor["componentType"] == 5126) accessor["componentType"] = 5122;
        const std::string scene = file.save_glb(folder_.path / "n.glb").string();
        const std::string line = error_of({"render", scene, "-o", path("o.exr")}, 1);
        EXPECT_NE(line.find(std::string(key) + ": must be an array of strings"), line.npos) << line;
    }
}

TEST_F(Trust, FilesThatCamerasNameLieBesideTheScene) {
    fs::create_directories(path("scene"));
    fs::copy_file(fs::path(PETZVAL_ASSETS) / "lenses/tessar-100mm-f2.8.json", path("lens.json"));
    text_file("iris.svg", R"(<svg><rect width="2" height="1"/></svg>)");
    const auto save = [&](const std::string& lens, const std::string& iris) {
        TinyGltf file = studio();
        file.json["cameras"][0]["extras"]["petzval"] = {{"lens", lens}, {"aperture", iris}};
        return file.save_gltf(folder_.path / "scene/s.gltf").string();
    };
    ProcessOptions here;
    here.folder = folder_.path;
    const auto said = [&](const std::string& lens, const std::string& iris, const Words& more) {
        Words words{"render", save(lens, iris), "--size", "8x8", "--spp",
                    "1",      "--focus",        "3",      "-o",  path("o.exr")};
        words.insert(words.end(), more.begin(), more.end());
        const Finished done = run_petzval(words, here);
        return done.exit_code == 0 ? std::string() : done.err;
    };
    const std::string ships = "tessar-100mm-f2.8", absolute = "is an absolute path";
    EXPECT_EQ(said(ships, "star:5", {}), "");
    EXPECT_EQ(said("../lens.json", "../iris.svg", {}), "");
    EXPECT_NE(said(path("lens.json"), "circle", {}).find(absolute), std::string::npos);
    EXPECT_NE(said(ships, path("iris.svg"), {}).find(absolute), std::string::npos);
    EXPECT_NE(said("lens.json", "circle", {}), "") << "of the folder that it runs in";
    EXPECT_NE(said(ships, "iris.svg", {}), "");
    // Whatever camera or option a render takes, and without a look at whether such a file is there.
    const Words confined = {"--confine", "--lens", ships, "--aperture", "circle"};
    for (const auto& [lens, iris] : {std::pair<std::string, std::string>{"../lens.json", "circle"},
                                     {ships, "../iris.svg"},
                                     {"../none.json", "circle"},
                                     {path("lens.json"), "circle"}}) {
        EXPECT_NE(said(lens, iris, confined).find("lies outside"), std::string::npos) << lens;
        const Finished info = run_petzval({"info", save(lens, iris), "--confine"}, here);
        EXPECT_EQ(info.exit_code, 1) << lens;
        EXPECT_NE(info.err.find("lies outside"), std::string::npos) << info.err;
        EXPECT_EQ(run_petzval({"info", save(lens, iris)}, here).exit_code, 0);
    }
    EXPECT_EQ(run_petzval({"info", save(ships, "star:5"), "--confine"}, here).exit_code, 0);
}

TEST_F(Trust, AStreamThatIsNotThereIsNoOutput) {
    for (const char* name : {"/proc/x.exr", "/dev/fd/77.exr"}) {
        const std::string line = error_of(words({"--spp", "1000000000", "-o", name}), 3);
        EXPECT_NE(line.find("cannot be written"), line.npos) << line;
    }
}

}  // namespace
}  // namespace petzval::apps
