/* Texts in XML files. */
#pragma once

/* Text as the value of an attribute, owned by the caller; what XML cannot hold becomes an underscore.
   NULL without memory. */
char *tobi_xml_escape(const char *text);
