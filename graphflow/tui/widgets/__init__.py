"""Building blocks of views: tables, forms, dialogs, drawings, and their styles."""
