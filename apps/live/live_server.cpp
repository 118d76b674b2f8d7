// SPDX-License-Identifier: Apache-2.0
#include "apps/live/live_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <map>
#include <thread>

#include "apps/live/facts.h"
#include "apps/live/guard.h"
#include "apps/live/lens_bench.h"
#include "apps/live/lessons.h"
#include "apps/live/open_pages.h"
#include "apps/live/page_files.h"
#include "apps/live/saved_file.h"
#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "camera/lens/lens.h"
#include "io/base/error.h"
#include "io/lens/lens_drawing.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {
namespace {

using httplib::Request, httplib::Response;
using Json = nlohmann::json;

constexpr size_t kMostBody_bytes = 65536;
/// A stream that has nothing to tell looks this often whether its page is still there.
constexpr std::chrono::milliseconds kBreath{250};

constexpr int kBadRequest = 400, kForbidden = 403, kNotFound = 404, kConflict = 409,
              kUnavailable = 503;

// Nothing of other sites is loaded, and no other site shows the page in a frame.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

void answer(Response& response, const Json& json, int status = 200) {
    response.status = status;
    response.set_content(text_of(json), "application/json");
}

void refuse(Response& response, int status, const std::string& why, const std::string& field = "") {
    answer(response, {{"error", as_options(why)}, {"field", field}}, status);
}

void add_security_headers(Response& response) {
    for (const auto& [name, value] : {std::pair{"Content-Security-Policy", kPolicy},
                                      {"X-Content-Type-Options", "nosniff"},
                                      {"Referrer-Policy", "no-referrer"},
                                      {"Cache-Control", "no-store"},
                                      {"Cross-Origin-Resource-Policy", "same-origin"}})
        response.set_header(name, value);
}

// Number of a query's parameter; 0 where it is none.
uint64_t number_of(const Request& request, const char* name) {
    uint64_t out = 0;
    const std::string text = request.get_param_value(name);
    std::from_chars(text.data(), text.data() + text.size(), out);
    return out;
}

// As an address names a host: one that means all addresses of a machine is no name of it.
std::string name_in_address(const std::string& host) {
    if (host == "0.0.0.0" || host == "::") {
        std::array<char, 256> name{};
        return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
    }
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::vector<float> channel_of(const io::PictureRows& light, const std::string& name) {
    const int channel = io::channel_index(light.layout, name);
    if (channel < 0) throw ValueError("channel", "is none of this picture");
    const size_t width = size_t(light.layout.width), count = light.layout.channels.size();
    std::vector<float> row(width * count), out;
    for (int y = 0; y < light.layout.height; ++y) {
        light.row(y, row.data());
        for (size_t x = 0; x < width; ++x) out.push_back(row[x * count + size_t(channel)]);
    }
    return out;
}

std::string event_of(const char* name, const Json& json) {
    return fmt::format("event: {}\ndata: {}\n\n", name, text_of(json));
}

}  // namespace

class LiveServer::Site {
  public:
    explicit Site(LiveOptions options)
        : options_(std::move(options)),
          pages_(options_.start),
          files_(read_page_files()),
          facts_(program_facts(pages_.rules())) {
        // Its pictures are of a scene of its own.
        auto learn = files_.extract("learn.html");
        if (options_.learn) files_.at("index.html") = std::move(learn.mapped());
        if (options_.listen) gate_.token = random_token();
        // A browser keeps six connections, each of which keeps a thread.
        server_.new_task_queue = [] { return new httplib::ThreadPool(8 * kMostPages); };
        constexpr time_t kPatience_s = 2;  // with a client that stops in the middle of a request
        server_.set_keep_alive_timeout(kPatience_s);
        server_.set_read_timeout(kPatience_s);
        server_.set_keep_alive_max_count(10'000);
        server_.set_payload_max_length(kMostBody_bytes);
        server_.set_tcp_nodelay(true);
        // Not SO_REUSEPORT, with which two servers share a port.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        });
        route();
    }

    ~Site() {
        closing_ = true;
        server_.stop();
    }

    /// Listens; the address of the page.
    std::string start() {
        const std::string host = options_.listen.value_or("127.0.0.1");
        int port = options_.port;
        if (port == 0)
            port = server_.bind_to_any_port(host);
        else if (!server_.bind_to_port(host, port))
            port = -1;
        if (port < 0)
            throw ValueError(
                options_.port == 0 ? "--listen" : "--port",
                fmt::format("nobody can listen on {}{}: either the address is none of this "
                            "machine's, or another program listens there; --port 0 takes a free "
                            "port",
                            host,
                            options_.port == 0 ? "" : fmt::format(", port {}", options_.port)));
        constexpr int kUsualPort = 80;  // which browsers leave out
        for (const char* name : {"127.0.0.1", "localhost"})
            gate_.hosts.push_back(port == kUsualPort ? name : fmt::format("{}:{}", name, port));
        thread_ = std::jthread([this] { server_.listen_after_bind(); });
        while (!server_.is_running())  // before that stop() does nothing
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return fmt::format("http://{}:{}/{}", name_in_address(host), port,
                           gate_.token.empty() ? "" : gate_.token + "/");
    }

  private:
    using Handler = void (Site::*)(const Request&, Response&);

    void route() {
        server_.set_pre_routing_handler([this](const Request& request, Response& response) {
            add_security_headers(response);
            const auto header = [&](const char* name) { return request.get_header_value(name); };
            const std::string why = refusal_of(
                {request.method, request.path, header("Host"), header("Origin"),
                 header("Sec-Fetch-Site"), header("Sec-Fetch-Mode"), header("Content-Type"),
                 request.has_header("Content-Encoding") || request.has_header("Transfer-Encoding")},
                gate_);
            if (why.empty()) return httplib::Server::HandlerResponse::Unhandled;
            refuse(response, kForbidden, why);
            return httplib::Server::HandlerResponse::Handled;
        });
        server_.set_exception_handler(
            [](const Request&, Response& response, const std::exception_ptr& error) {
                try {
                    std::rethrow_exception(error);
                } catch (const ValueError& fault) {
                    refuse(response, kBadRequest, fault.what(), fault.option());
                } catch (const std::exception& fault) {
                    refuse(response, kBadRequest, fault.what());
                }
            });
        const std::map<std::string, Handler> gets{
            {"/api/facts", &Site::tell_facts},     {"/api/events", &Site::stream_events},
            {"/api/picture", &Site::send_picture}, {"/api/file", &Site::send_file},
            {"/api/values", &Site::send_values},   {"/api/pixel", &Site::tell_pixel},
            {"/api/lens", &Site::send_lens},       {"/api/lens.svg", &Site::draw_lens}};
        server_.Get(".*", [this, gets](const Request& request, Response& response) {
            const std::string path = path_behind_token(request.path, gate_);
            if (const auto found = gets.find(path); found != gets.end())
                return (this->*found->second)(request, response);
            send_page(path == "/" ? "index.html" : path.substr(1), response);
        });
        const std::map<std::string, Handler> posts{{"/api/request", &Site::take_request},
                                                   {"/api/bench", &Site::measure_lens},
                                                   {"/api/lesson", &Site::teach},
                                                   {"/api/lens", &Site::take_lens}};
        server_.Post(".*", [this, posts](const Request& request, Response& response) {
            if (const auto found = posts.find(path_behind_token(request.path, gate_));
                found != posts.end())
                return (this->*found->second)(request, response);
            refuse(response, kNotFound, "there is nothing under this address");
        });
    }

    void send_page(const std::string& name, Response& response) {
        const auto file = files_.find(name);
        if (file == files_.end())
            return refuse(response, kNotFound, "there is nothing under this address");
        response.set_content(file->second.bytes, file->second.type);
    }

    void tell_facts(const Request&, Response& response) { answer(response, facts_); }

    std::shared_ptr<Viewer> viewer_of(const Request& request) {
        return pages_.viewer_of(request.get_param_value("page"));
    }

    void stream_events(const Request& request, Response& response) {
        const std::string page = pages_.open(request.get_param_value("page"));
        if (page.empty())
            return refuse(response, kUnavailable,
                          fmt::format("{} pages are open already; close or hide one", kMostPages));
        struct Told {
            uint64_t number = 0;
            const Scene* scene = nullptr;
            bool greeted = false;
        };
        const auto told = std::make_shared<Told>();
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, page, told, viewer = pages_.viewer_of(page)](size_t, httplib::DataSink& sink) {
                std::string text;
                if (!told->greeted) {
                    told->greeted = true;
                    text = event_of("page", {{"page", page}});
                } else {
                    const LiveStatus now = viewer->wait(told->number, kBreath);
                    const LoadedScene scene = viewer->scene().loaded;
                    if (scene.prepared.scene.get() != told->scene) {
                        told->scene = scene.prepared.scene.get();
                        text += event_of("scene", scene_facts(scene));
                    }
                    if (now.number != told->number) {
                        told->number = now.number;
                        text += event_of("status", status_facts(now));
                    }
                }
                if (closing_ || !sink.is_writable()) return false;
                return text.empty() || sink.write(text.data(), text.size());
            },
            [this, page](bool) { pages_.close(page); });
    }

    void take_request(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body, nullptr, false);
        if (!asked.is_object() || !asked.contains("page") || !asked["page"].is_string() ||
            !asked.contains("version") || !asked["version"].is_number_unsigned() ||
            !asked.contains("fields") || !asked["fields"].is_object())
            return refuse(response, kBadRequest,
                          "a request is {\"page\": ..., \"version\": 1, \"fields\": {...}}");
        const auto viewer = pages_.viewer_of(asked["page"]);
        viewer->leave();  // what is shown is of other settings, even if these are refused
        const RenderOrder order = order_of_page(asked["fields"], pages_.rules_for(asked["page"]));
        viewer->ask(asked["version"], order.render);
        answer(response, {{"command", options_.command(order)}});
    }

    void send_picture(const Request& request, Response& response) {
        const auto picture = viewer_of(request)->picture();
        if (!picture) return refuse(response, kNotFound, "there is no picture yet");
        response.set_header("X-Size", fmt::format("{}x{}", picture->size_px.x, picture->size_px.y));
        response.set_content(reinterpret_cast<const char*>(picture->rgba.data()),
                             picture->rgba.size(), "application/octet-stream");
    }

    void send_file(const Request& request, Response& response) {
        const std::string name = request.get_param_value("name");
        const auto viewer = viewer_of(request);
        const uint64_t version = number_of(request, "version");
        response.set_header("Content-Disposition", "attachment");
        response.set_content(
            saved_file(name,
                       [&](const std::filesystem::path& path) { viewer->write(version, path); }),
            "application/octet-stream");
    }

    // Values of a channel, 32-bit floats row by row.
    void send_values(const Request& request, Response& response) {
        const std::string name = request.get_param_value("channel");
        std::vector<float> values;
        viewer_of(request)->inspect(
            number_of(request, "version"),
            [&](const RenderSession& session) { values = channel_of(session.light(), name); });
        response.set_content(reinterpret_cast<const char*>(values.data()),
                             values.size() * sizeof(float), "application/octet-stream");
    }

    // All channels of a pixel.
    void tell_pixel(const Request& request, Response& response) {
        Json pixel = Json::object();
        const uint64_t x = number_of(request, "x"), y = number_of(request, "y");
        viewer_of(request)->inspect(
            number_of(request, "version"), [&](const RenderSession& session) {
                const io::PictureRows light = session.light();
                if (x >= uint64_t(light.layout.width) || y >= uint64_t(light.layout.height))
                    throw ValueError("x,y", "lies outside of the picture");
                const std::vector<std::string>& channels = light.layout.channels;
                std::vector<float> row(channels.size() * size_t(light.layout.width));
                light.row(static_cast<int>(y), row.data());
                for (size_t i = 0; i < channels.size(); ++i)
                    pixel[channels[i]] = number_or_null(double(row[x * channels.size() + i]));
            });
        answer(response, pixel);
    }

    // {"lens": text of a lens file, "height_mm", "focus_m", "fstop"}.
    void measure_lens(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body);
        answer(response, bench_facts({asked.at("lens"), asked.at("height_mm"), asked.at("focus_m"),
                                      asked.at("fstop")}));
    }

    // {"lesson": its name, "fields": as of a request}.
    void teach(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body);
        answer(response,
               lesson_facts(asked.at("lesson"), order_of_page(asked.at("fields"), pages_.rules())));
    }

    void send_lens(const Request& request, Response& response) {
        response.set_content(io::text_of_shipped(request.get_param_value("name")),
                             "application/json");
    }

    void take_lens(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body);
        const std::string text = asked.at("lens");
        (void)io::parse_lens(text, "lens");
        answer(response, {{"lens", pages_.keep_lens(asked.at("page"), text).string()}});
    }

    void draw_lens(const Request& request, Response& response) {
        const std::string name = request.get_param_value("name");
        const camera::Lens lens(io::parse_lens(io::text_of_shipped(name), name).lens);
        const io::LensDrawing drawing{.film_mm = lens.film_mm(),
                                      .film_radius_mm = lens.prescription().image_circle_mm / 2,
                                      .rays = {},
                                      .caption = ""};
        response.set_content(io::lens_svg(lens, drawing), "image/svg+xml");
    }

    LiveOptions options_;
    OpenPages pages_;
    std::map<std::string, PageFile> files_;
    Json facts_;
    ServerGate gate_;
    std::atomic<bool> closing_ = false;
    httplib::Server server_;
    std::jthread thread_;  ///< last: it uses the others
};

LiveServer::LiveServer(LiveOptions options) : site_(std::make_unique<Site>(std::move(options))) {
    address_ = site_->start();
}

LiveServer::~LiveServer() = default;

}  // namespace petzval::apps
