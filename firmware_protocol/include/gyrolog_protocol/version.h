/// Protocol version. A receiver accepts frames of its own major version only (SPEC.md, Versioning).
#ifndef GYROLOG_PROTOCOL_VERSION_H
#define GYROLOG_PROTOCOL_VERSION_H

#define GLP_PROTOCOL_MAJOR 1U
#define GLP_PROTOCOL_MINOR 1U

#endif
