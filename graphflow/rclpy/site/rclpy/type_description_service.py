"""The parameter that says whether a node describes its types. The service itself is answered by graphflow."""

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
