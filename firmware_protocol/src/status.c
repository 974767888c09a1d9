#include <gyrolog_protocol/status.h>

const char* glp_status_name(glp_status status) {
    switch (status) {
        case glp_status_ok:
            return "ok";
        case glp_status_bad_cobs:
            return "bad_cobs";
        case glp_status_bad_length:
            return "bad_length";
        case glp_status_bad_crc:
            return "bad_crc";
        case glp_status_bad_version:
            return "bad_version";
        case glp_status_bad_value:
            return "bad_value";
        case glp_status_no_space:
            return "no_space";
        case glp_status_count:
            break;
    }
    return "unknown";
}
