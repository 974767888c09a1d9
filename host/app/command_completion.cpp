#include <memory>
#include <string>

#include "host/app/command.hpp"
#include "host/app/completion.hpp"
#include "host/app/result_output.hpp"

namespace gyrolog {

Action setup_completion(CLI::App& app) {
    auto shell = std::make_shared<std::string>();
    app.add_option("SHELL", *shell, "bash, zsh or fish")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    return [shell, root = app.get_parent()](Console& console) {
        ResultOutput results(console);
        results.show(completion_script(*root, *shell).value_or(""));
        const Status done = results.finish();
        return done.ok() ? ExitCode::ok : report_error(console, "completion", done.error());
    };
}

}  // namespace gyrolog
