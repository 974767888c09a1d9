#include <memory>
#include <string>
#include <vector>

#include "host/app/command.hpp"
#include "host/app/manual_page.hpp"
#include "host/app/option_check.hpp"
#include "host/app/result_output.hpp"
#include "host/base/nearest_name.hpp"

namespace gyrolog {
namespace {

const CLI::App* command_of(const CLI::App& root, const std::string& name) {
    const auto commands = root.get_subcommands([&](const CLI::App* app) { return app->get_name() == name; });
    return commands.empty() ? nullptr : commands.front();
}

}  // namespace

Action setup_manual(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    const CLI::App* root = app.get_parent();
    // Asked once the words are parsed: the commands are not all declared yet.
    const auto is_command = [root](const std::string& text) -> std::string {
        if (command_of(*root, text) != nullptr) { return {}; }
        const std::string meant = nearest_name(text, all_command_names());
        return "there is no command '" + text + "'" + (meant.empty() ? "" : "; did you mean " + meant + "?");
    };
    app.add_option("COMMAND", *name, "The command; without one, the page of the program itself")
        ->check(CLI::Validator(is_command, ""))
        ->check(offered(all_command_names()));
    return [name, root](Console& console) {
        ResultOutput results(console);
        results.show(name->empty() ? manual_page(*root) : manual_page_of_command(*command_of(*root, *name)));
        const Status done = results.finish();
        return done.ok() ? ExitCode::ok : report_error(console, "manual", done.error());
    };
}

}  // namespace gyrolog
