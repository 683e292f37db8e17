"""The building blocks of views: tables, forms, dialogs, drawings, and the styles that they share."""
