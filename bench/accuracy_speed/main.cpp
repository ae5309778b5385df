// carom_accuracy_speed: every setting of the methods on a set of scenes, how long each takes and how wrong it
// is. bench/accuracy runs it and makes of its CSV the tables and pictures of docs/accuracy-speed.md.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "study.hpp"

namespace carom::bench {
namespace {

constexpr const char* kUsage =
    "carom_accuracy_speed [--quick] [--scene NAME] [--rounds N] [--scenes FOLDER]\n"
    "  --quick          small scenes and few settings\n"
    "  --scene NAME     one scene (all); given again, another\n"
    "  --rounds N       of timing at least, of which the median counts (3)\n"
    "  --scenes FOLDER  where screensaver.json lies (scenes)\n"
    "Two tables as CSV, each after a line that names it: scenes, settings. On one thread.\n";

struct Options {
    bool quick = false;
    std::vector<std::string> names;
    int rounds = 3;
    std::string scenes = "scenes";
};

bool read(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        if (name == "--quick") {
            options.quick = true;
            continue;
        }
        if (++i == argc) return false;
        if (name == "--scene")
            options.names.emplace_back(argv[i]);
        else if (name == "--scenes")
            options.scenes = argv[i];
        else if (name == "--rounds")
            options.rounds = std::atoi(argv[i]);
        else
            return false;
    }
    return options.rounds > 0;
}

void add(std::string& table, const Record& record) {
    if (table.empty()) table = names_of(record) + "\n";
    table += values_of(record) + "\n";
}

void run(const Options& options) {
    std::string scenes;
    std::string settings;
    const trade::Timing timing{.least_rounds = options.rounds, .enough_seconds = options.quick ? 0 : 0.3};
    for (const std::string& name : options.names.empty() ? study_names() : options.names) {
        const StudyScene scene = study_scene(name, options.quick, options.scenes);
        const Reference reference = reference_of(scene);
        add(scenes, record_of(scene, reference));
        for (const Setting& setting : settings_of(scene, options.quick)) {
            std::fprintf(stderr, "%s: %s\n", name.c_str(), setting.name.c_str());
            std::optional<trade::TimeRatio> time;
            if (setting.is_choice)
                time = trade::time_ratio(setting.scene, scene.scene, scene.course.duration(), timing);
            add(settings, record_of(scene, reference, setting, time));
        }
    }
    std::printf("table scenes\n%stable settings\n%s", scenes.c_str(), settings.c_str());
}

}  // namespace
}  // namespace carom::bench

int main(int argc, char** argv) {
    using namespace carom::bench;
    if (argc == 2 && std::string(argv[1]) == "--help") {
        std::fputs(kUsage, stdout);
        return 0;
    }
    Options options;
    if (!read(argc, argv, options)) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    try {
        run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "carom_accuracy_speed: %s\n", error.what());
        return 1;
    }
}
