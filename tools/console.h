// What the program says while it works: on stderr, as text or as one JSON object a line. Results go
// to stdout and do not pass here.
#pragma once

#include <string>

namespace scree {

enum class LogFormat { text, json };

class Console {
public:
    LogFormat format = LogFormat::text;
    bool isVerbose = false;
    bool isQuiet = false;

    void detail(const std::string& message);  ///< only with -v
    void info(const std::string& message);    ///< not with -q
    void warning(const std::string& message);
    void error(const std::string& message);  ///< fatal, once, last

    /// Replaces the status line of a terminal; messages appear above it.
    void redraw(const std::string& status);
    void clearStatus();

    /// What a signal asked for: also with -q.
    void answer(const std::string& message);

    /// A line as it is, whatever the format: for progress that another program reads.
    void line(const std::string& text);

private:
    void log(const char* level, const char* prefix, const std::string& message);

    std::string status_;
};

}  // namespace scree
