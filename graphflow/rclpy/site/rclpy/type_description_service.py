"""The parameter that decides whether a node describes its types; graphflow implements the service itself."""

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"
