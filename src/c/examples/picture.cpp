// Renders a scene and writes the picture as PPM: `picture SCENE > picture.ppm`.
#include <ninebit.h>

#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using Scene = std::unique_ptr<ninebit_scene, decltype(&ninebit_scene_free)>;

static void check(ninebit_status status, char *message)
{
    if (status == NINEBIT_STATUS_OK) return;
    std::string text = message ? message : "no memory";
    ninebit_text_free(message);
    throw std::runtime_error(text);
}

int main(int count, char **arguments)
try {
    char *message = nullptr;
    ninebit_scene *loaded = nullptr;
    check(ninebit_scene_load(count > 1 ? arguments[1] : "scene.ron", &loaded, &message), message);
    Scene scene(loaded, ninebit_scene_free);
    std::uint32_t width = 0, height = 0;
    check(ninebit_target_size(scene.get(), 0, &width, &height, &message), message);
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    check(ninebit_render(scene.get(), 0, 0, nullptr, rgba.data(), rgba.size() / 4, &message), message);
    std::printf("P6 %u %u 255\n", width, height);
    for (std::size_t n = 0; n < rgba.size(); n += 4) std::fwrite(&rgba[n], 1, 3, stdout);
    // If the reader ends early, SIGPIPE ends the program, as usual on Unix; a full disk is reported.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw std::runtime_error("the picture cannot be written");
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
