// The page of `gearloss open`: the program is reached over HTTP.

import { theme } from "../theme.ts";
import { Http, tokenOfPage } from "./transport.ts";
import { Workbench } from "./workbench.ts";

const token = tokenOfPage();
if (token === null) {
  theme(document.getElementById("theme") as HTMLButtonElement);
  document.documentElement.dataset.locked = "";
} else void new Workbench(new Http(token)).start();
