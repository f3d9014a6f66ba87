"""Program text to scopes of statements (grammars, python, modelica), and those to claims: a name with its formula."""
